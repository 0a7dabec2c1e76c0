"""``python -m contactlab`` is the command ``contactlab``."""

import sys

from contactlab.cli.main import main

sys.exit(main())
