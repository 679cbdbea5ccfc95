"""Mutations that know what a file is made of: numbers, words, lines, archives and bytes."""

from __future__ import annotations

import io
import random
import re
import struct
import zipfile
from collections.abc import Sequence

MOST_BYTES = 40_000
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*")
NUMBERS = (
    b"0", b"-0", b"-1", b"1e400", b"-1e308", b"1e-320", b"nan", b"inf", b"-inf", b"1_5", b"1e", b"0x10", b".", b"1.2.3",
    b"99999999999999999999", b"2147483647", b"-2147483648", b"1" + b"0" * 400, b"9" * 5000, "１".encode(), b"1e9dB",
)  # fmt: skip
PIECES = (
    b"\0", b"\xff\xfe", b"\xef\xbb\xbf",
    b'"', b"'", b'"""', b"[", b"[[", b"]", b"{", b"}", b"\\", b"\\u0000", b"%", b"$x^{",
    b"../../../evil", b"/dev/zero", b"\r", b"\r\n", b"\n\n", b"\t", b",", b";", b"=", b"#", b"{run!r}",
    b"{0.__class__}", b"<script>", "é".encode(), "\u202e".encode(), b"\xed\xa0\x80", b"[" * 300,
    b"," * 300, b"= 1\n" * 30,
)  # fmt: skip


def mutate(data: bytes, others: Sequence[bytes], draw: random.Random, binary: bool) -> bytes:
    """One to four mutations of ``data``; pieces are taken from ``others`` too."""
    if data[:2] == b"PK" and draw.random() < 0.6:
        return _archive(data, others, draw)
    for _ in range(draw.choice((1, 1, 2, 4))):
        data = draw.choice(BYTES if binary else TEXT)(data, others, draw) or b"\n"
    return data[:MOST_BYTES]


def _archive(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    """A member of an archive changed, its checksums right again."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()[:10]}
    except Exception:  # an archive that an earlier mutation has broken
        return _bits(data, others, draw)
    name = draw.choice(list(members) or ["a_NS.npy"])
    members[name] = draw.choice((_bits, _number, _cut, _insert))(members.get(name, b"x"), others, draw)
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", draw.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))) as archive:
        for member, content in members.items():
            archive.writestr(member, content)
    return written.getvalue()


def _replaced(pattern: re.Pattern[bytes], data: bytes, by: bytes, draw: random.Random) -> bytes:
    found = list(pattern.finditer(data))
    if not found:
        return data + by
    # the first lines say what the rest is
    match = draw.choice(found[:40] if draw.random() < 0.7 else found)
    return data[: match.start()] + by + data[match.end() :]


def _number(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    return _replaced(NUMBER, data, draw.choice((*NUMBERS, str(draw.randint(-20, 2000)).encode())), draw)


def _word(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    words = WORD.findall(draw.choice(others)) or [b"x"]
    return _replaced(WORD, data, draw.choice((draw.choice(words), b"", draw.choice(PIECES))), draw)


def _lines(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    lines = data.splitlines(keepends=True) or [b""]
    k, j = (draw.randrange(min(len(lines), 40)) for _ in range(2))
    kind = draw.randrange(4)
    if kind == 0:
        del lines[k : k + draw.choice((1, 1, 5))]
    elif kind == 1:
        lines.insert(k, lines[j])
    elif kind == 2:
        lines[k], lines[j] = lines[j], lines[k]
    else:
        theirs = draw.choice(others).splitlines(keepends=True) or [b"\n"]
        lines.insert(k, draw.choice(theirs))
    return b"".join(lines)


def _insert(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    at = draw.randrange(len(data) + 1)
    return data[:at] + draw.choice(PIECES) + data[at:]


def _cut(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    at, length = draw.randrange(len(data) + 1), draw.choice((1, 3, 20, len(data)))
    return data[:at] + data[at + length :]


def _splice(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    other = draw.choice(others)
    return data[: draw.randrange(len(data) + 1)] + other[draw.randrange(len(other) + 1) :]


def _bits(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    changed = bytearray(data)
    for _ in range(draw.choice((1, 1, 3, 10))):
        if changed:
            changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
    return bytes(changed)


def _integers(data: bytes, others: Sequence[bytes], draw: random.Random) -> bytes:
    """Sizes and offsets as binary headers hold them."""
    value = draw.choice((0, 1, 0x7FFFFFFF, 0xFFFFFFFF, 0xFFFFFFFE, draw.getrandbits(16), 1 << 30))
    raw = (
        struct.pack(draw.choice(("<I", ">I", "<Q", ">Q", "<H")), value & 0xFFFF if draw.random() < 0.2 else value)
        if (value < 1 << 16)
        else struct.pack(draw.choice(("<I", ">I", "<Q", ">Q")), value)
    )
    at = draw.randrange(max(1, len(data) - 8))
    return data[:at] + raw + data[at + len(raw) :]


TEXT = (_number, _number, _word, _lines, _insert, _cut, _splice, _bits)
BYTES = (_bits, _bits, _integers, _integers, _cut, _insert, _splice)
