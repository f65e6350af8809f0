"""Watch a long call from another thread, and stop it early with what it has reached.

    python watch_and_stop.py mesh.npz

The file holds `vertices` (n,3) and `faces` (m,3).
"""

import sys
import threading

import numpy as np
import ridgeform

data = np.load(sys.argv[1])
mesh = ridgeform.Mesh(data["vertices"], data["faces"])
progress = ridgeform.Progress()
results = []

call = threading.Thread(
    target=lambda: results.append(ridgeform.stylize(mesh, iterations=1000, progress=progress))
)
call.start()
while call.is_alive():
    call.join(timeout=0.05)
    if progress.iteration >= 5:
        progress.finish()  # keep what is there; cancel() would raise Cancelled instead

print(f"stopped after {results[0].iterations} steps: {results[0].status}")
print(f"{progress.stage!r}, energy {results[0].energy[-1]:.3f}")
