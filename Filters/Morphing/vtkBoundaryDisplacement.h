// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBoundaryDisplacement
 * @brief   moves a part of a mesh's boundary, and defines what the rest of the boundary does
 *
 * One filter makes the displaced boundary from a mesh: what moves, how it moves, and what the rest
 * does.
 *
 * - Moving defines what moves: all of the boundary, a selection of points or cells, surfaces (the
 *   surfaces and curves that vtkClassifyBoundary finds), or what is inside an implicit function, a
 *   box for instance.
 * - Motion defines how: by a transform, by a vector, along the normals, or by a point vector array
 *   of the input. Or by a field of other data, onto a target surface, by handles, or by a lattice;
 *   each times ScaleFactor.
 * - Surroundings defines what the rest does. It stays, follows as with vtkMorphBoundary (curves
 *   first, then surfaces; vertices are held), or fades out with the distance from what moves.
 *   FixedSurfaces stay in any case, except for the nodes that they share with what moves. Mid-side
 *   and face nodes next to these keep their place between their corners.
 *
 * Port 0 takes the mesh (vtkUnstructuredGrid, or composite data, see vtkMorphAlgorithm), or its
 * boundary (vtkPolyData) as vtkExtractMorphBoundary, vtkClassifyBoundary or this filter writes it:
 * several of these filters in a row move several parts, each in its own way. Such a boundary moves
 * from its current position. Its geometry is that of its point arrays GeometryDimension and
 * GeometryId, or is found at its RestPosition. Port 1, optional, takes the vtkSelection of
 * MOVING_SELECTION. Selected cells move all of their nodes that are on the boundary. Port 2,
 * optional, takes the target of DISPLACEMENT_TARGET (vtkPolyData, an STL file for instance). Port
 * 3, optional, takes the selection of a zone. Port 4, optional, takes the control points of
 * DISPLACEMENT_HANDLES and DISPLACEMENT_LATTICE. Port 5, optional, takes the data of
 * DISPLACEMENT_FIELD.
 *
 * The output is the boundary as vtkClassifyBoundary writes it on its port 1, at its displaced
 * points: the input of port 1 of a morph filter. Two point arrays are added:
 * - `Role` (signed char, active scalars): 0 stays, 1 moves, 2 is held, 3 follows or fades,
 *   4 is free, 5 is of a zone, 6 of a layer;
 * - `BoundaryDisplacement` (active vectors): the point as written minus its RestPosition.
 * No motion gives the input's points bit for bit.
 *
 * The filter is made for dragging: it keeps boundary, geometry and weights while the input, the
 * chosen parts and the options that they depend on are the same (ClassifyCount, PrepareCount). The
 * result does not depend on what was kept.
 *
 * RequestInformation reads the input's data where they are up to date. It finds the boundary's
 * surfaces, so that a window can list their names before the first execution, and keeps what it
 * finds for that execution. On a large mesh this takes as long as the first execution would.
 *
 * Warnings: nodes that do not reach the target; faces that the motion leaves without area (a scale
 * of zero, for instance); surfaces that it would reflect; a mesh without any outer face, whose
 * boundary is empty. Errors: those of vtkClassifyBoundary; a surface without polygons, MorphPointId
 * or RestPosition; nothing chosen, or nothing on the boundary; a target without polygons, with
 * coordinates that are not finite, or that no node reaches; surfaces or arrays that do not exist;
 * positions that are not finite, beyond 1e50, or in single precision beyond 3.4e38; nodes without a
 * normal. The output is then empty: a morph would take an unchanged boundary for a motion of zero.
 * An execution that is aborted gives an empty output and no message. Cost, where everything is
 * kept: a few passes over the boundary.
 *
 * With several MPI ranks all of them have to execute it. Of a mesh in pieces each rank gathers the
 * whole boundary, and keeps the part of its cells; ids are global, and the target is gathered, too.
 * Surfaces are then listed after the first execution. Errors there: zones, KeepLayers, picking in a
 * view, and a boundary instead of the mesh on port 0.
 *
 * M. L. Staten, S. J. Owen, S. M. Shontz, A. G. Salinger, T. S. Coffey, "A Comparison of Mesh
 * Morphing Methods for 3D Shape Optimization", Proc. 20th Int. Meshing Roundtable (2011) 293-311.
 *
 * Errors of handles and lattices: none at all, those in the same place, arrays or columns that are
 * missing, not numeric or of the wrong length, and control points outside of LatticeSize.
 *
 * @sa vtkDisplacementAlgorithm vtkMorphBoundary vtkClassifyBoundary vtkExtractMorphBoundary
 * vtkMorphAlgorithm
 */
#ifndef vtkBoundaryDisplacement_h
#define vtkBoundaryDisplacement_h

#include "vtkDisplacementAlgorithm.h"
#include "vtkMeshMorphingFiltersMorphingModule.h" // for export macro

class vtkPolyData;

class VTKMESHMORPHINGFILTERSMORPHING_EXPORT vtkBoundaryDisplacement
  : public vtkDisplacementAlgorithm
{
public:
  static vtkBoundaryDisplacement* New();
  vtkTypeMacro(vtkBoundaryDisplacement, vtkDisplacementAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * The displaced boundary.
   */
  vtkPolyData* GetOutput();

  /**
   * The target of the last execution in triangles, as aligned; null without DISPLACEMENT_TARGET.
   */
  vtkPolyData* GetFittedTarget();

  ///@{
  /**
   * The number of points with each Role in the last execution. 0 where there was no result. See
   * GetZonePoints() and GetLayerPoints() for the others.
   */
  vtkIdType GetMovingPoints() const;
  vtkIdType GetFixedPoints() const;
  vtkIdType GetFollowingPoints() const;
  vtkIdType GetFreePoints() const;
  ///@}

  ///@{
  /**
   * How often this object has found the boundary's geometry, evaluated the choice of what moves,
   * and computed the weights by which a surface follows or the boundary fades.
   */
  int GetClassifyCount() const;
  int GetChooseCount() const;
  int GetPrepareCount() const;
  ///@}

protected:
  vtkBoundaryDisplacement();
  ~vtkBoundaryDisplacement() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkBoundaryDisplacement(const vtkBoundaryDisplacement&) = delete;
  void operator=(const vtkBoundaryDisplacement&) = delete;
};

#endif
