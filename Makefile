# Everything is set up in .ridgeform/ on the first run, and only what changed is done again.
PYTHON ?= python3
RUN = @$(PYTHON) scripts/setup_env.py

.PHONY: help demo test lint bench bench-holes bench-segments notices advisories extension wheel fixtures pictures gallery

help:
	@echo "make demo        stylize a real scan in Blender, without a window: out/demo.png, out/demo.blend"
	@echo "make test        all tests: Rust, the wheel, the extension in every Blender found"
	@echo "make lint        formatting and lints of Rust and Python"
	@echo "make notices     write the licences of all dependencies again: rust/THIRD-PARTY-NOTICES.txt"
	@echo "make advisories  ask the database of known vulnerabilities about the dependencies; needs the network"
	@echo "make bench       measure against peers: benchmarks/results.md, the table in the README"
	@echo "                 ARGS=--quick: a minute, keeps nothing; ARGS=--large: a million vertices as well"
	@echo "make bench-holes fill holes with known truth by every tool: benchmarks/holes.md"
	@echo "make bench-segments  segment shapes of known parts: benchmarks/segments.md"
	@echo "make wheel       build the Python wheel"
	@echo "make extension   build and check the Blender extension: .ridgeform/extension/"
	@echo "make fixtures    make the .blend files of blend_fixtures/ again"
	@echo "make pictures    draw the results in docs/pictures/ again"
	@echo "make gallery     compute and draw docs/pictures/gallery/ and the tables of docs/gallery.md again"

demo:
	$(RUN) scripts/demo.py

test:
	$(RUN) scripts/run_tests.py

lint:
	$(RUN) scripts/lint.py

notices:
	$(RUN) scripts/notices.py

advisories:
	$(RUN) scripts/advisories.py

bench:
	$(RUN) benchmarks/run.py $(ARGS)

bench-holes:
	$(RUN) benchmarks/holes.py $(ARGS)

bench-segments:
	$(RUN) benchmarks/segments.py $(ARGS)

extension:
	$(RUN) scripts/build_extension.py

wheel:
	$(RUN) scripts/build_wheel.py

# Blender notes the home folder in every file it saves, hence the neutral one; saved by the oldest Blender.
fixtures:
	$(RUN)
	HOME=/ PYTHONPATH=tests .ridgeform/py311/bin/python blend_fixtures/make_fixtures.py

pictures:
	$(RUN) scripts/manual_pictures.py

gallery:
	$(RUN) scripts/draw_gallery.py
