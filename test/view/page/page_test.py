"""Tests the viewer's page with headless Chromium and a fake server.

Usage: page_test.py [--only NAME] [--screenshots FOLDER]
Needs the Python packages playwright, aiohttp and numpy, and Chromium; exit status 77 without them.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from page_harness import browser  # first: skips where packages are missing

import connection_tests
import layout_tests
import panel_tests
import picture_tests

HERE = Path(__file__).resolve().parent


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    parser.add_argument("--screenshots")
    options = parser.parse_args()
    layout_tests.screenshots = options.screenshots
    tests = {name[5:]: f for module in (picture_tests, panel_tests, connection_tests, layout_tests)
             for name, f in vars(module).items() if name.startswith("test_") and options.only in name}
    failed = []
    with browser() as b:
        for name, test in tests.items():
            start = time.monotonic()
            try:
                test(b)
                print(f"{name}: passed, {time.monotonic() - start:.1f} s", flush=True)
            except Exception as error:  # also of Playwright
                failed.append(name)
                where = error.__traceback__
                while where.tb_next and "page_harness" not in where.tb_next.tb_frame.f_code.co_filename \
                        and Path(where.tb_next.tb_frame.f_code.co_filename).parent == HERE:
                    where = where.tb_next
                file = Path(where.tb_frame.f_code.co_filename).name
                print(f"{name}: FAILED in {file}:{where.tb_lineno}: {error}", flush=True)
    print(json.dumps({"tests": len(tests), "failed": failed}))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
