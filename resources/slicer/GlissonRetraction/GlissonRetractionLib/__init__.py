# SPDX-License-Identifier: GPL-3.0-or-later
"""What the module GlissonRetraction does, without Slicer's classes."""
