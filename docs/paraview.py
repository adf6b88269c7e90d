# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of docs/results.md: a frame of a results.h5 in ParaView.

Run: .venv/bin/epdem run cases/settle_glass.toml && pvbatch docs/paraview.py runs/settle_glass/results.h5 3
On a machine without a screen: xvfb-run -s -noreset pvbatch ...
"""

import sys
from pathlib import Path

from paraview import simple

FIGURE = Path(__file__).resolve().parent / "figures" / "paraview.png"


def main(path: str, frame: str) -> None:
    """Draw a frame, counted from 0: the spheres by the clicks of docs/results.md, the walls half transparent."""
    reader = simple.VTKHDFReader(FileName=[path])
    view = simple.CreateRenderView(ViewSize=[700, 800], UseColorPaletteForBackground=0, Background=[1.0, 1.0, 1.0])
    view.OrientationAxesVisibility = 0
    view.ViewTime = reader.TimestepValues[int(frame)]
    block = simple.ExtractBlock(Input=reader, Assembly="Assembly", Selectors=["//spheres"])
    spheres = simple.Glyph(Input=block, GlyphType="Sphere", GlyphMode="All Points")
    spheres.ScaleArray, spheres.OrientationArray = ["POINTS", "radius"], ["POINTS", "No orientation array"]
    spheres.ScaleFactor = 1.0
    ball = spheres.GlyphType
    ball.Radius, ball.ThetaResolution, ball.PhiResolution = 1.0, 24, 24
    balls, walls = simple.Show(spheres, view), simple.Show(reader, view)
    simple.ColorBy(balls, ("POINTS", "velocity", "Magnitude"))
    balls.RescaleTransferFunctionToDataRange()
    walls.Opacity, walls.DiffuseColor = 0.25, [0.5, 0.6, 0.8]
    view.CameraPosition, view.CameraViewUp = [1.0, -1.8, 0.9], [0.0, 0.0, 1.0]
    simple.ResetCamera(view)
    simple.SaveScreenshot(str(FIGURE), view)


main(*sys.argv[1:])
