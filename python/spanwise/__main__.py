"""``python -m spanwise``: the command line."""

import sys

from spanwise.cli import main

sys.exit(main())
