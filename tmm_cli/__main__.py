"""`python -m tmm_cli`."""

from tmm_cli.cli.app import main

if __name__ == "__main__":
    main()
