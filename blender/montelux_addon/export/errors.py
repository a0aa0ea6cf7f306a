# SPDX-License-Identifier: GPL-3.0-or-later
"""ExportError: the scene cannot be rendered, in one sentence for the user."""


class ExportError(Exception):
    pass
