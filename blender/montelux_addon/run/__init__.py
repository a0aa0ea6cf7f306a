# SPDX-License-Identifier: GPL-3.0-or-later
"""The program as a child process: its command, its picture while it renders, its picture at the end."""
