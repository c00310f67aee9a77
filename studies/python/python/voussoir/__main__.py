"""The command line: `voussoir`, or `python -m voussoir`."""

import sys

from . import _voussoir


def main() -> None:
    """Does what the arguments of the process ask for, and ends it."""
    sys.stdout.flush()
    sys.exit(_voussoir.main(sys.argv[1:]))


if __name__ == "__main__":
    main()
