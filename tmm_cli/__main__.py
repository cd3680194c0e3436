"""Entry point of `tmm` and `python -m tmm_cli`.

After Ctrl-C the program ends without a traceback, even while its modules are being imported.
"""

import sys


def main() -> None:
    """Run the command `tmm`."""
    try:
        from tmm_cli.cli import main as command

        command()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
