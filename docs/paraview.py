# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of docs/results.md: a frame of a results.h5 by VTK's own reader, without a screen.

Run: .venv/bin/epdem run cases/settle_glass.toml && .venv/bin/python docs/paraview.py runs/settle_glass/results.h5 3
"""

import sys
from pathlib import Path

import vtk

FIGURE = Path(__file__).parent / "figures" / "paraview.png"


def spheres(block: vtk.vtkPolyData) -> vtk.vtkActor:
    """A ball of its radius at each point, coloured by the speed."""
    block.GetPointData().SetActiveScalars("radius")
    ball, glyphs = vtk.vtkSphereSource(), vtk.vtkGlyph3D()
    ball.SetRadius(1.0)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(24)
    glyphs.SetInputData(block)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    glyphs.SetScaleModeToScaleByScalar()
    glyphs.OrientOff()
    glyphs.Update()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyphs.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("velocity")
    colours = vtk.vtkLookupTable()
    colours.SetHueRange(0.66, 0.0)
    colours.SetVectorModeToMagnitude()
    colours.SetRange(glyphs.GetOutput().GetPointData().GetArray("velocity").GetRange(-1))
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def wall(block: vtk.vtkPolyData) -> vtk.vtkActor:
    """The triangles of a wall, half transparent."""
    mapper, actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
    mapper.SetInputData(block)
    mapper.ScalarVisibilityOff()
    actor.SetMapper(mapper)
    actor.GetProperty().SetOpacity(0.25)
    actor.GetProperty().SetColor(0.5, 0.6, 0.8)
    return actor


def main(path: str, frame: str) -> None:
    """Draw a frame, counted from 0."""
    reader, scene, window = vtk.vtkHDFReader(), vtk.vtkRenderer(), vtk.vtkRenderWindow()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.SetStep(int(frame))
    reader.Update()
    blocks = reader.GetOutputDataObject(0)
    for k in range(blocks.GetNumberOfPartitionedDataSets()):
        scene.AddActor((wall if k else spheres)(blocks.GetPartition(k, 0)))
    scene.SetBackground(1.0, 1.0, 1.0)
    camera = scene.GetActiveCamera()
    camera.SetPosition(1.0, -1.8, 0.9)
    camera.SetViewUp(0.0, 0.0, 1.0)
    scene.ResetCamera()
    camera.Zoom(1.0)
    window.SetOffScreenRendering(1)
    window.SetSize(700, 800)
    window.AddRenderer(scene)
    window.SetMultiSamples(8)
    window.Render()
    image, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
    image.SetInput(window)
    writer.SetFileName(str(FIGURE))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


main(*sys.argv[1:])
