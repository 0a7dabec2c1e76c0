"""The command line: one file a subcommand.

A subcommand is a module of this package with its name in ``main.COMMANDS``. The module docstring is
the help (one line, then examples), ``add_arguments(parser)`` adds the arguments, and
``execute(arguments)`` returns the exit status. A subcommand prints data on stdout and everything
else on stderr, and raises ``ValueError`` for bad input.
"""
