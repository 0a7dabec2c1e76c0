"""psi2 by tables: of elastic impacts, and of impacts with a restitution.

One format of files (``file``) and one evaluator (``patches``); ``elastic`` and ``restituted`` know
the coordinates in which psi2 is smooth. The builders of both are in the repository,
``plugins/table_builders``, and not in the installed package.
"""
