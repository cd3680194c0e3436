"""The door of the command: `tmm`, `python -m tmm_cli`. What is imported later may be interrupted too."""

import sys


def main() -> None:
    """Entry point of the command."""
    try:
        from tmm_cli.cli import main as command

        command()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
