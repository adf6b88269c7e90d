// SPDX-License-Identifier: GPL-2.0-or-later
// LIGGGHTS's headers include this list several times; Debian's package has no copy, because LIGGGHTS's build makes it.
// Empty on purpose: the plugin brings its own normal models and never builds the models of LIGGGHTS.
