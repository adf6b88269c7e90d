# SPDX-License-Identifier: GPL-2.0-or-later
"""The proof: every engine, law and model of another code compared with theory and with each other.

It may import every other package of epdem. None imports it but `epdem.__main__`, where the command begins.
"""
