# SPDX-License-Identifier: GPL-3.0-or-later
"""Files on the workers of a Dask cluster, each of which keeps a Blender process of its own.

Dask hands a file of a worker that is gone to another one. The journal, in a folder that all see, makes sure
that it is not done twice.
"""

import contextlib
import os
import secrets
import sys
from collections.abc import Iterator, Sequence

from ..framework.targets import Target
from . import helper, worker
from .one_file import Plan
from .pool import lost

CONNECT_SECONDS = 30.0


class DaskError(Exception):
    """A cluster that cannot be used; the message says why."""


def run(
    targets: Sequence[Target],
    plan: Plan,
    arguments: Sequence[str],
    *,
    indices: Sequence[int],
    address: str,
    timeout: float | None,
) -> Iterator[tuple[int, dict[str, object]]]:
    """The records of files as they are done, by the cluster of a scheduler. `DaskError`.

    The workers must find Blender, or Python with `bpy`, and all files at the same paths as this process.
    """
    try:
        import cloudpickle  # noqa: PLC0415
        from distributed import Client, as_completed  # noqa: PLC0415
    except ImportError as error:
        raise DaskError(
            f"--dask needs the package distributed in the Python of {sys.executable}: {error}"
        ) from error
    # The workers have neither `bpy` nor the add-on.
    cloudpickle.register_pickle_by_value(helper)
    command = worker.command(arguments)
    # A worker takes as many files at once as it has threads.
    order = worker.order(plan, 1, None)
    try:
        client = Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise DaskError(f"there is no Dask scheduler at {address}: {error}") from error
    try:
        run_of = secrets.token_hex(8)
        futures = {
            client.submit(
                helper.in_dask,
                command,
                order,
                os.getcwd(),
                index,
                timeout,
                key=f"ridgeform-{run_of}-{index}",
                pure=False,
            ): index
            for index in indices
        }
        # In the loop of this client: by default that of another one, if there is any.
        found = as_completed(list(futures), loop=client.loop, with_results=True, raise_errors=False)
        for future, answer in found:
            index = futures.pop(future)
            if future.status == "finished":
                why = answer.get("lost")
            else:
                error = answer[1] if isinstance(answer, tuple) else answer
                why = f"Dask: {type(error).__name__}: {error}"
            # Dask keeps results for as long as somebody has their future.
            future.release()
            record = answer if why is None else lost(targets[index], plan, why)
            # A worker may have ended with its answer: the next one has it from the journal.
            yield index, record | {"resumed": False}
    finally:
        # The scheduler may be gone as well.
        with contextlib.suppress(OSError, TimeoutError):
            client.cancel(list(futures), force=True)
            client.run(helper.end_in_dask)
        client.close()
        cloudpickle.unregister_pickle_by_value(helper)
