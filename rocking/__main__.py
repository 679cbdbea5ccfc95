"""``python -m rocking``."""

from rocking.command import main

if __name__ == "__main__":
    main()
