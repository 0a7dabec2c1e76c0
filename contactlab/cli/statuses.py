"""Exit statuses of every command."""

#: The last two are those of a shell for a program that a signal ended.
OK, FAILED, BAD_INPUT, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 130, 141
