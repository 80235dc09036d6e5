"""Whether there is memory, where what needs it cannot be refused it."""

from mmap import MAP_ANON, MAP_PRIVATE, mmap


def ask_for(size: int) -> None:
    """Ask for memory and give it back, before native code needs it that does not ask.

    Args:
        size: bytes of address space.

    Raises:
        MemoryError: there is not so much of it.
    """
    try:
        mmap(-1, size, flags=MAP_PRIVATE | MAP_ANON).close()
    except OSError as error:
        raise MemoryError from error
