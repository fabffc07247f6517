import sys

from aisle_tools.cli import main

sys.exit(main())
