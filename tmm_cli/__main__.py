"""Entry point of `tmm` and `python -m tmm_cli`. Later imports can be interrupted without a traceback."""

import sys


def main() -> None:
    """Run the command."""
    try:
        from tmm_cli.cli import main as command

        command()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
