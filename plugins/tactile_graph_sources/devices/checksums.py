"""16-bit checksums over many packets of one length at a time."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Crc16(NamedTuple):
    """One CRC: polynomial, start value, and whether bits run from the low end."""

    polynomial: int
    start: int
    reflected: bool


VARIANTS = {
    "ccitt-false": Crc16(0x1021, 0xFFFF, False),
    "xmodem": Crc16(0x1021, 0x0000, False),
    "kermit": Crc16(0x8408, 0x0000, True),
    "modbus": Crc16(0xA001, 0xFFFF, True),
    "arc": Crc16(0xA001, 0x0000, True),
}


def _after_byte(crc: int, byte: int, kind: Crc16) -> int:
    if kind.reflected:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ kind.polynomial if crc & 1 else crc >> 1
        return crc
    crc ^= byte << 8
    for _ in range(8):
        crc = ((crc << 1) ^ kind.polynomial if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


@cache
def _tables(variant: str, length: int) -> tuple[NDArray[np.uint16], int]:
    """Return what each byte value at each place adds, shape (length, 256), and the constant.

    A CRC is linear over XOR, so the CRC of a packet is the XOR of one table entry per byte: a
    gather instead of a loop over bytes.
    """
    kind = VARIANTS[variant]
    step = np.array([_after_byte(0, b, kind) for b in range(256)], dtype=np.uint16)

    def shifted(crc: NDArray[np.uint16]) -> NDArray[np.uint16]:  # one zero byte later
        if kind.reflected:
            return np.asarray((crc >> 8) ^ step[crc & 0xFF], dtype=np.uint16)
        return np.asarray(((crc << 8) & 0xFFFF) ^ step[crc >> 8], dtype=np.uint16)

    table = np.empty((length, 256), dtype=np.uint16)
    table[length - 1] = step
    for place in range(length - 2, -1, -1):
        table[place] = shifted(table[place + 1])
    constant = np.array([kind.start], dtype=np.uint16)
    for _ in range(length):
        constant = shifted(constant)
    return table, int(constant[0])


def crc16(packets: NDArray[np.uint8], variant: str) -> NDArray[np.uint16]:
    """Return the checksum of each row of ``packets``, shape (k, length), uint8."""
    length = packets.shape[1]
    table, constant = _tables(variant, length)
    parts = table[np.arange(length), packets]
    folded: NDArray[np.uint16] = np.bitwise_xor.reduce(parts, axis=1)
    return folded ^ np.uint16(constant)
