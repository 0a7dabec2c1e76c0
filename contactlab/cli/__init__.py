"""The command line: one file a subcommand.

A subcommand is a module that an entry point ``command.NAME`` names, of this package or of another
distribution. The module docstring is the help (one line, then examples), and its hook
``contactlab_command(parser)`` adds the arguments and returns the function that runs it. A
subcommand prints data on stdout and everything else on stderr, and raises ``ValueError`` for bad
input.
"""
