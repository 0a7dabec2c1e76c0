"""The command line: one file a subcommand.

A subcommand is a module of this package, named in ``main.COMMANDS``. Its docstring is its help
(one line, then examples), ``add_arguments(parser)`` adds its arguments, and
``execute(arguments)`` does the work and returns the exit status. It prints data on stdout,
everything else on stderr, and raises ``ValueError`` for bad input.
"""
