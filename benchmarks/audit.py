"""What is installed below this program, held against what its packages say of themselves: ``make audit``.

Works without a network. For every distribution that the program needs, directly or not: version, licence, and whether
its files are those that it came with (their SHA-256 in RECORD). Then files on the path of modules that would be
executed at every start and belong to no distribution (``.pth``), and with ``--advisories FILE`` (a JSON list of
``{"package", "below", "id"}``, as exported where there is a network) the versions that are known to be vulnerable.
Exit code 1 when a file has changed, something runs unasked, or an advisory holds.
"""

from __future__ import annotations

import argparse
import base64
import csv
import hashlib
import json
import re
import site
import sys
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.version import Version

ROOT = "rocking-study"


def canonical(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(name: str, found: dict[str, metadata.Distribution] | None = None) -> dict[str, metadata.Distribution]:
    """The distribution and all that it needs here, by canonical name; optional extras are left out."""
    found = {} if found is None else found
    try:
        distribution = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return found
    found[canonical(name)] = distribution
    for line in distribution.requires or ():
        requirement = Requirement(line)
        if requirement.marker is not None and not requirement.marker.evaluate({"extra": ""}):
            continue
        if canonical(requirement.name) not in found:
            needed(requirement.name, found)
    return found


def changed_files(distribution: metadata.Distribution) -> list[str]:
    """Files that are not as they were installed, or are gone."""
    record = distribution.read_text("RECORD") or ""
    wrong = []
    for name, digest, _ in csv.reader(record.splitlines()):
        if not digest or name.endswith(".pyc"):
            continue
        kind, _, expected = digest.partition("=")
        path = Path(str(distribution.locate_file(name)))
        data = path.read_bytes() if path.is_file() else b""
        actual = base64.urlsafe_b64encode(hashlib.new(kind, data).digest()).rstrip(b"=").decode()
        if actual != expected:
            wrong.append(name)
    return wrong


def run_unasked() -> Iterator[str]:
    """Lines of ``.pth`` files that are executed at every start, by files that no distribution names."""
    owned = {
        Path(str(file.locate())).resolve()
        for one in metadata.distributions()
        for file in one.files or ()
        if file.suffix == ".pth"
    }
    for folder in {*site.getsitepackages(), site.getusersitepackages()}:
        for path in sorted(Path(folder).glob("*.pth")):
            lines = [
                line
                for line in path.read_text("utf-8", "replace").splitlines()
                if line.startswith(("import ", "import\t"))
            ]
            if lines and path.resolve() not in owned:
                yield f"{path.name}: {lines[0][:80]}"


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--advisories", type=Path)
    given = parser.parse_args()
    advisories = json.loads(given.advisories.read_text("utf-8")) if given.advisories else []
    findings = [*run_unasked()]
    print(f"{'distribution':<22}{'version':<16}{'changed files':>14}  licence")
    for name, distribution in sorted(needed(ROOT).items()):
        wrong = changed_files(distribution)
        about = distribution.metadata
        licence = (
            about.get("License-Expression") or (about.get("License") or "").strip().split("\n")[0] or "see its files"
        )
        print(f"{name:<22}{distribution.version:<16}{len(wrong):>14}  {licence[:60]}")
        findings += [f"{name}: {file} is not as it was installed" for file in wrong]
        findings += [
            f"{name} {distribution.version}: {one['id']}, fixed in {one['below']}"
            for one in advisories
            if canonical(one["package"]) == name and Version(distribution.version) < Version(one["below"])
        ]
    print("\n".join(findings) or "nothing found")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
