"""CRC-16 against the published check values."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_sources.devices.checksums import crc16


@pytest.mark.parametrize(
    ("variant", "check"),
    [
        ("ccitt-false", 0x29B1),
        ("xmodem", 0x31C3),
        ("kermit", 0x2189),
        ("modbus", 0x4B37),
        ("arc", 0xBB3D),
    ],
)
def test_the_check_value_of_each_variant(variant: str, check: int) -> None:
    """The CRC of the ASCII digits 1 to 9, as catalogues of CRCs give it; several rows at once."""
    rows = np.frombuffer(b"123456789" * 3, np.uint8).reshape(3, 9)
    assert crc16(rows, variant).tolist() == [check] * 3
