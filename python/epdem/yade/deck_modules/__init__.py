# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of decks: phases and output of a scene (`recorder`, `spheres`), impacts without epdem_yade (`contacts`)."""
