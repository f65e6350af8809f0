"""The licenses of all that is linked into the wheel: `rust/THIRD-PARTY-NOTICES.txt`, from the lock file.

    python scripts/setup_env.py scripts/notices.py [--check]

Writes the file; with --check, stops if it is not what the lock file asks for. Stops as well at a crate whose
license text cannot be had.
"""

import argparse
import json
import re
import subprocess
import tomllib
import zipfile
from collections import defaultdict
from pathlib import Path

from workspace import ROOT, stop

NOTICES = ROOT / "rust/THIRD-PARTY-NOTICES.txt"
ROOT_CRATE = "ridgeform-python"
OWN_TEXT = ROOT / "rust/LICENSE-MIT"
LEGAL = re.compile(r"(licen[cs]e|unlicense|copying|copyright|notice)", re.IGNORECASE)
"""Names of files that must go along with a crate."""
CALLED_IN_FILES = {
    "MIT": "mit",
    "Apache-2.0": "apache",
    "Unlicense": "unlicense",
    "Zlib": "zlib",
    "BSD-2-Clause": "bsd",
}
"""How file names call the licenses that crates offer to choose from."""
STANDARD_LIBRARY = ("The Rust standard library", "MIT OR Apache-2.0", "The Rust Project Developers")
RULE = "=" * 80

Crate = dict[str, object]


def shipped_crates() -> list[Crate]:
    """The packages that are linked into the wheel on any platform of deny.toml, without this project's own.

    Crates that run while compiling only (build scripts, macros) are not in the wheel.
    """
    targets = tomllib.loads((ROOT / "deny.toml").read_text(encoding="utf-8"))["graph"]["targets"]
    command = ["cargo", "metadata", "--locked", "--format-version", "1"]
    command += [word for target in targets for word in ("--filter-platform", target)]
    found = json.loads(subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout)
    crates = {crate["id"]: crate for crate in found["packages"]}
    nodes = {node["id"]: node for node in found["resolve"]["nodes"]}
    shipped: set[str] = set()
    waiting = [key for key, crate in crates.items() if crate["name"] == ROOT_CRATE]
    while waiting:
        key = waiting.pop()
        if key in shipped or any("proc-macro" in target["kind"] for target in crates[key]["targets"]):
            continue
        shipped.add(key)
        waiting += [
            needed["pkg"]
            for needed in nodes[key]["deps"]
            if any(kind["kind"] is None for kind in needed["dep_kinds"])
        ]
    # What has no source is in this repository.
    others = [crates[key] for key in shipped if crates[key]["source"] is not None]
    return sorted(others, key=lambda crate: (crate["name"], crate["version"]))


def texts(crate: Crate, others: list[Crate]) -> list[str]:
    """The license texts and notices of a crate: its own files, or the standard text with its authors."""
    offered = re.split(r"\s+OR\s+|\s*/\s*", crate["license"] or "")
    left_out = [CALLED_IN_FILES[name] for name in offered if name in CALLED_IN_FILES and name != "MIT"]
    if "MIT" not in offered or len(offered) == 1:
        left_out = []
    folder = Path(crate["manifest_path"]).parent
    files = [
        path
        for path in sorted(folder.iterdir())
        if path.is_file()
        and LEGAL.match(path.name)
        and not any(word in path.name.lower() for word in left_out)
    ]
    result = [_text_of(path) for path in files]
    if any(path.name.lower().startswith("licen") for path in files):
        return result
    # Where several licenses are offered, MIT is taken; its text is the same for all but the authors.
    if "MIT" not in offered:
        stop(f"{crate['name']} {crate['version']} ships no text of its license, {crate['license']}")
    same_home = [
        other for other in others if other["repository"] and other["repository"] == crate["repository"]
    ]
    holders = crate["authors"] or sorted({name for other in same_home for name in other["authors"]})
    if not holders and crate["repository"]:
        holders = [f"the authors of {crate['repository']}"]
    if not holders:
        stop(f"{crate['name']} {crate['version']} ships no license text and names no authors")
    return [standard_text(", ".join(re.sub(r"\s*<.*>", "", name) for name in holders)), *result]


def standard_text(holders: str) -> str:
    """The MIT license with the names of its copyright holders."""
    return re.sub(r"Copyright .*", f"Copyright (c) {holders}", _text_of(OWN_TEXT), count=1)


def _text_of(path: Path) -> str:
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    return "\n".join(line.rstrip() for line in lines).strip()


def _section(names: list[str], text: str) -> str:
    return "\n".join([RULE, *names, RULE, "", text])


def notices() -> str:
    """The whole file: every text once, under the names of all crates that it belongs to."""
    crates = shipped_crates()
    users: dict[str, list[str]] = defaultdict(list)
    spelled: dict[str, str] = {}
    title, license_, holders = STANDARD_LIBRARY
    for name, each in [
        (f"{title} ({license_})", [standard_text(holders)]),
        *((f"{c['name']} {c['version']} ({c['license']})", texts(c, crates)) for c in crates),
    ]:
        for text in each:
            # Texts that differ in line breaks only are one.
            key = " ".join(text.split())
            spelled.setdefault(key, text)
            users[key].append(name)
    head = (
        "Ridgeform's native module contains the software listed here, each part under its own license.\n"
        f"Made from Cargo.lock by scripts/notices.py: {len(crates)} packages, {len(users)} texts."
    )
    parts = [_section(names, spelled[key]) for key, names in users.items()]
    return "\n\n\n".join([head, *parts]) + "\n"


def extension_notices(wheels: list[Path]) -> str:
    """The notices of an extension: those of the native module, and the licenses in the wheels of others."""
    users: dict[str, set[str]] = defaultdict(set)
    for wheel in wheels:
        name, number = wheel.name.split("-")[:2]
        if name == "ridgeform":
            continue
        with zipfile.ZipFile(wheel) as archive:
            found = [path for path in archive.namelist() if LEGAL.match(path.rsplit("/", 1)[-1])]
            if not found:
                stop(f"{wheel.name} holds no license text")
            for path in found:
                users[archive.read(path).decode().strip()].add(f"{name} {number}")
    parts = [_section(sorted(names), text) for text, names in users.items()]
    head = "The wheels of other projects in this extension come under the licenses at the end of this file."
    return "\n\n\n".join([head, NOTICES.read_text(encoding="utf-8").rstrip(), *parts]) + "\n"


def main() -> None:
    """Write the file, or check it."""
    parser = argparse.ArgumentParser(description="Collect the licenses of what is linked into the wheel.")
    parser.add_argument("--check", action="store_true", help="write nothing, stop if the file is out of date")
    wanted = notices()
    if not parser.parse_args().check:
        NOTICES.write_text(wanted, encoding="utf-8")
    elif not NOTICES.is_file() or NOTICES.read_text(encoding="utf-8") != wanted:
        stop(f"{NOTICES.relative_to(ROOT)} is not what Cargo.lock asks for: run `make notices`")


if __name__ == "__main__":
    main()
