"""Being somebody who is bound by the permissions of files, as root is not."""

import ctypes
import os
import struct

NOBODY = 65534
CAPABILITIES_3 = 0x20080522
"""The version of the two structures that Linux takes."""
BEYOND_PERMISSIONS = (1 << 1) | (1 << 2)
"""CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH, by which root reads and writes any file."""


def give_up_root() -> None:
    """Read and write from now on only what one may.

    Where the system can, root stays the owner of its files: libraries read fonts and migrations
    late, and the code may lie where nobody else may look.
    """
    if os.getuid() != 0:
        return
    libc = ctypes.CDLL(None, use_errno=True)
    if not hasattr(libc, "capget"):
        os.setgid(NOBODY)
        os.setuid(NOBODY)
        return
    header = struct.pack("=Ii", CAPABILITIES_3, 0)
    held = ctypes.create_string_buffer(24)
    assert libc.capget(header, held) == 0, os.strerror(ctypes.get_errno())
    effective, permitted, inherited, *rest = struct.unpack("=6I", held.raw)
    kept = [word & ~BEYOND_PERMISSIONS for word in (effective, permitted, inherited)]
    assert libc.capset(header, struct.pack("=6I", *kept, *rest)) == 0
