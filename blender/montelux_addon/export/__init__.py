# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated scene as files that the program reads: a .glb, and an environment map."""
