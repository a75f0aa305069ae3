# state file generated using paraview version 5.11.0
import paraview
paraview.compatibility.major = 5
paraview.compatibility.minor = 11

#### import the simple module from the paraview
from paraview.simple import *
#### disable automatic camera reset on 'Show'
paraview.simple._DisableFirstRenderCameraReset()

# ----------------------------------------------------------------
# setup views used in the visualization
# ----------------------------------------------------------------

# Create a new 'Render View'
renderView1 = CreateView('RenderView')
renderView1.AxesGrid = 'GridAxes3DActor'
renderView1.StereoType = 0
renderView1.CameraPosition = [2.87524786094193, -0.3090759941257417, 43.03050863066496]
renderView1.CameraFocalPoint = [2.87524786094193, -0.3090759941257417, 6.7271136563805785]
renderView1.CameraFocalDisk = 1.0
renderView1.CameraParallelScale = 9.396010021223933

SetActiveView(None)

# ----------------------------------------------------------------
# setup view layouts
# ----------------------------------------------------------------

# create new layout object 'Layout #1'
layout1 = CreateLayout(name='Layout #1')
layout1.AssignView(0, renderView1)
layout1.SetSize(400, 400)

# ----------------------------------------------------------------
# restore active view
SetActiveView(renderView1)
# ----------------------------------------------------------------

# ----------------------------------------------------------------
# setup the data processing pipelines
# ----------------------------------------------------------------

# create a new 'XML Unstructured Grid Reader'
bore = XMLUnstructuredGridReader(registrationName='bore', FileName=['/place/of/the/data/bore_hex_small.vtu'])
bore.PointArrayStatus = ['GeometryDimension', 'GeometryId', 'CurveParameter', 'FinalDisplacement']

# create a new 'Boundary Displacement'
moved = BoundaryDisplacement(registrationName='moved', Input=bore,
    Selection=None,
    Target=None,
    ControlPoints=None,
    ZoneSelection=None)
moved.Moving = 'Region'
moved.Region = 'Box'
moved.Transform = 'Transform'
moved.Surroundings = 'Follow everywhere'
moved.ZoneRegion = 'Box'

# init the 'Box' selected for 'Region'
moved.Region.Position = [-4.0, -4.0, 6.0]
moved.Region.Length = [8.0, 8.0, 7.0]

# init the 'Transform' selected for 'Transform'
moved.Transform.Translate = [1.2, 0.5, 1.5]
moved.Transform.Rotate = [10.0, 20.0, 30.0]

# init the 'Box' selected for 'ZoneRegion'
moved.ZoneRegion.Position = [1.0, 1.0, 1.0]

# create a new 'Morph Inversion Free'
inversionfree = MorphInversionFree(registrationName='Inversion-free', Input=bore,
    Boundary=moved)
inversionfree.ScaleFactor = 0.9

# create a new 'Morph Simplex Linear'
simplexlinear = MorphSimplexLinear(registrationName='Simplex-linear', Input=bore,
    Boundary=moved)
simplexlinear.ScaleFactor = 0.9

# create a new 'Morph FEMWARP'
fEMWARP = MorphFEMWARP(registrationName='FEMWARP', Input=bore,
    Boundary=moved)
fEMWARP.ScaleFactor = 0.9

# create a new 'Scaled Jacobian'
quality = ScaledJacobian(registrationName='quality', Input=fEMWARP)

# ----------------------------------------------------------------
# setup the visualization in view 'renderView1'
# ----------------------------------------------------------------

# show data from quality
qualityDisplay = Show(quality, renderView1, 'UnstructuredGridRepresentation')

# get 2D transfer function for 'ScaledJacobian'
scaledJacobianTF2D = GetTransferFunction2D('ScaledJacobian')

# get color transfer function/color map for 'ScaledJacobian'
scaledJacobianLUT = GetColorTransferFunction('ScaledJacobian')
scaledJacobianLUT.AutomaticRescaleRangeMode = 'Never'
scaledJacobianLUT.TransferFunction2D = scaledJacobianTF2D
scaledJacobianLUT.RGBPoints = [-1.0, 0.45, 0.0, 0.55, -1e-12, 1.0, 0.0, 1.0, 0.0, 0.65, 0.0, 0.15, 0.2, 0.9, 0.35, 0.2, 0.4, 0.99, 0.75, 0.4, 0.6, 0.9, 0.95, 0.75, 0.8, 0.35, 0.7, 0.75, 1.0, 0.1, 0.3, 0.6]
scaledJacobianLUT.ColorSpace = 'RGB'
scaledJacobianLUT.NanColor = [0.75, 0.75, 0.75]
scaledJacobianLUT.Discretize = 0
scaledJacobianLUT.ScalarRangeInitialized = 1.0

# get opacity transfer function/opacity map for 'ScaledJacobian'
scaledJacobianPWF = GetOpacityTransferFunction('ScaledJacobian')

# trace defaults for the display properties.
qualityDisplay.Representation = 'Surface With Edges'
qualityDisplay.ColorArrayName = ['CELLS', 'ScaledJacobian']
qualityDisplay.LookupTable = scaledJacobianLUT
qualityDisplay.SelectTCoordArray = 'None'
qualityDisplay.SelectNormalArray = 'None'
qualityDisplay.SelectTangentArray = 'None'
qualityDisplay.OSPRayScaleArray = 'CurveParameter'
qualityDisplay.OSPRayScaleFunction = 'PiecewiseFunction'
qualityDisplay.SelectOrientationVectors = 'MorphDisplacement'
qualityDisplay.ScaleFactor = 1.367401145751367
qualityDisplay.SelectScaleArray = 'ScaledJacobian'
qualityDisplay.GlyphType = 'Arrow'
qualityDisplay.GlyphTableIndexArray = 'ScaledJacobian'
qualityDisplay.GaussianRadius = 0.06837005728756836
qualityDisplay.SetScaleArray = ['POINTS', 'CurveParameter']
qualityDisplay.ScaleTransferFunction = 'PiecewiseFunction'
qualityDisplay.OpacityArray = ['POINTS', 'CurveParameter']
qualityDisplay.OpacityTransferFunction = 'PiecewiseFunction'
qualityDisplay.DataAxesGrid = 'GridAxesRepresentation'
qualityDisplay.PolarAxes = 'PolarAxesRepresentation'
qualityDisplay.ScalarOpacityFunction = scaledJacobianPWF
qualityDisplay.ScalarOpacityUnitDistance = 1.6287073705317903
qualityDisplay.OpacityArrayName = ['CELLS', 'ScaledJacobian']
qualityDisplay.SelectInputVectors = ['POINTS', 'MorphDisplacement']
qualityDisplay.WriteLog = ''

# init the 'PiecewiseFunction' selected for 'ScaleTransferFunction'
qualityDisplay.ScaleTransferFunction.Points = [0.0, 0.0, 0.5, 0.0, 0.9687499999999999, 1.0, 0.5, 0.0]

# init the 'PiecewiseFunction' selected for 'OpacityTransferFunction'
qualityDisplay.OpacityTransferFunction.Points = [0.0, 0.0, 0.5, 0.0, 0.9687499999999999, 1.0, 0.5, 0.0]

# show data from inversionfree
inversionfreeDisplay = Show(inversionfree, renderView1, 'UnstructuredGridRepresentation')

# trace defaults for the display properties.
inversionfreeDisplay.Representation = 'Surface With Edges'
inversionfreeDisplay.ColorArrayName = ['CELLS', 'ScaledJacobian']
inversionfreeDisplay.LookupTable = scaledJacobianLUT
inversionfreeDisplay.SelectTCoordArray = 'None'
inversionfreeDisplay.SelectNormalArray = 'None'
inversionfreeDisplay.SelectTangentArray = 'None'
inversionfreeDisplay.OSPRayScaleArray = 'CurveParameter'
inversionfreeDisplay.OSPRayScaleFunction = 'PiecewiseFunction'
inversionfreeDisplay.SelectOrientationVectors = 'MorphDisplacement'
inversionfreeDisplay.ScaleFactor = 1.367401145751367
inversionfreeDisplay.SelectScaleArray = 'ScaledJacobian'
inversionfreeDisplay.GlyphType = 'Arrow'
inversionfreeDisplay.GlyphTableIndexArray = 'ScaledJacobian'
inversionfreeDisplay.GaussianRadius = 0.06837005728756836
inversionfreeDisplay.SetScaleArray = ['POINTS', 'CurveParameter']
inversionfreeDisplay.ScaleTransferFunction = 'PiecewiseFunction'
inversionfreeDisplay.OpacityArray = ['POINTS', 'CurveParameter']
inversionfreeDisplay.OpacityTransferFunction = 'PiecewiseFunction'
inversionfreeDisplay.DataAxesGrid = 'GridAxesRepresentation'
inversionfreeDisplay.PolarAxes = 'PolarAxesRepresentation'
inversionfreeDisplay.ScalarOpacityFunction = scaledJacobianPWF
inversionfreeDisplay.ScalarOpacityUnitDistance = 1.6287073705317903
inversionfreeDisplay.OpacityArrayName = ['CELLS', 'ScaledJacobian']
inversionfreeDisplay.SelectInputVectors = ['POINTS', 'MorphDisplacement']
inversionfreeDisplay.WriteLog = ''

# init the 'PiecewiseFunction' selected for 'ScaleTransferFunction'
inversionfreeDisplay.ScaleTransferFunction.Points = [0.0, 0.0, 0.5, 0.0, 0.9687499999999999, 1.0, 0.5, 0.0]

# init the 'PiecewiseFunction' selected for 'OpacityTransferFunction'
inversionfreeDisplay.OpacityTransferFunction.Points = [0.0, 0.0, 0.5, 0.0, 0.9687499999999999, 1.0, 0.5, 0.0]

# ----------------------------------------------------------------
# setup color maps and opacity mapes used in the visualization
# note: the Get..() functions create a new object, if needed
# ----------------------------------------------------------------

# ----------------------------------------------------------------
# restore active source
SetActiveSource(quality)
# ----------------------------------------------------------------