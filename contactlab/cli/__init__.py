"""The command line: one file a subcommand.

A subcommand is a module that an entry point ``command.NAME`` names, of this package or of another
distribution. The module docstring is the help (one line, then examples), and its hook
``contactlab_command(parser)`` adds the arguments and returns the function that runs it. A
subcommand prints data on stdout and everything else on stderr, and raises ``ValueError`` for bad
input.
"""

#: Exit statuses; the last two are those of a shell for a program that a signal ended.
OK, FAILED, BAD_INPUT, INTERRUPTED, BROKEN_PIPE = 0, 1, 2, 130, 141
