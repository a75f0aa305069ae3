// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/InnerFaces.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/NamedSets.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <utility>
#include <vector>

class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
class WholeSurface;

/// The boundary of a mesh with its geometry, kept while the input stays the same. The input is a
/// grid, or a surface that was extracted from one before. Nodes are the input's points.
class BoundaryModel
{
public:
  /// Copies the input, a grid or polygonal data. An unmodified input costs nothing. The geometry is
  /// reused where a modified input has the same boundary and the same arrays that define its
  /// geometry. Throws morph::Error as Geometry::Classify() does, for a grid without volume cells,
  /// and for a surface without polygons, MorphPointId or RestPosition; then nothing is kept.
  /// `whole`: of a mesh on several MPI processes, whose Grid() is the input; else null.
  void Update(vtkPointSet* input, const Geometry::Options& options, morph::Monitor& monitor,
    const WholeSurface* whole = nullptr);

  /// Of a surface: its points, no cells.
  const morph::Mesh& Mesh() const { return this->Kept.Mesh; }
  const morph::Points& Points() const { return this->Kept.Mesh.points; } ///< current positions
  /// Undeformed positions: a surface's RestPosition, and a grid's own points.
  const morph::Points& Rest() const
  {
    return this->Kept.Mesh.numberOfCells() > 0 ? this->Kept.Mesh.points : this->Kept.Rest;
  }
  /// The outer faces, then those of baffles, then those of sheets; see innerFaces().
  const morph::BoundaryFaces& Faces() const { return this->Kept.Faces; }
  /// Whether all of these faces lie inside of the mesh.
  bool AreInner(const std::vector<morph::Index>& faces) const;
  /// The numbers of the surfaces that are sheets, ascending. They go along with the interior unless
  /// they are named.
  std::vector<morph::Index> Sheets() const;
  /// #nodes: whether a node is on some of these surfaces, ascending, and on no other.
  std::vector<std::uint8_t> NodesOnlyOn(const std::vector<morph::Index>& surfaces) const;
  /// The geometry; that of a surface is found at its RestPosition.
  const morph::Classification& Geometry() const { return this->Kept.Geometry; }
  /// What the mesh's file names on the boundary; see FindNamedSets().
  const std::vector<NamedSet>& NamedSets() const { return this->Kept.NamedSets; }
  /// What it names without any node on the boundary.
  const std::vector<NamedSet>& SetsInside() const { return this->Kept.SetsInside; }
  const std::vector<morph::Index>& BodyOfNode() const { return this->Kept.BodyOfNode; }
  /// The areas of morph::faceAreas(), but outwards where cells are wound inside out.
  morph::Points OutwardAreas(const morph::Points& points) const;

  /// Diagonal of the bounding box of the boundary's nodes, of which there is one at least.
  double Size() const { return this->Kept.Size; }

  /// The boundary as vtkClassifyBoundary writes it, at the input's points, with the input's arrays.
  vtkPolyData* Surface() const;
  /// The node of each point of Surface(), ascending.
  const std::vector<morph::Index>& NodeOfPoint() const { return this->Kept.NodeOfPoint; }
  /// The face of each polygon of Surface(), and the cell id of the first polygon.
  const std::vector<morph::Index>& FaceOfPolygon() const { return this->Kept.FaceOfPolygon; }
  morph::Index FirstPolygon() const;

  /// Changes with the input's content and with the options.
  vtkIdType InputVersion() const { return this->Kept.InputVersion; }
  /// Changes with Points(), Faces() and Geometry() alone.
  vtkIdType MotionVersion() const { return this->Kept.MotionVersion; }
  /// How often the geometry was found so far.
  int ClassifyCount() const { return this->Classified; }

private:
  struct State
  {
    morph::Mesh Mesh; ///< of a surface: no cells
    morph::BoundaryFaces Faces;
    std::vector<std::uint8_t> IsNamed;    ///< #cells: those of named sets
    morph::InnerFaces Inner;              ///< the last ones of Faces
    std::vector<std::int8_t> Orientation; ///< #faces
    morph::Points Rest;                   ///< of a surface: where its geometry was found
    std::vector<morph::Index> BodyOfNode;
    std::string GeometryKey;
    morph::Classification Geometry;
    std::vector<NamedSet> NamedSets, SetsInside;
    vtkSmartPointer<vtkPolyData> Surface;
    std::vector<morph::Index> NodeOfPoint, FaceOfPolygon;
    const vtkPointSet* Input = nullptr; ///< compared, never used
    vtkMTimeType InputTime = 0;
    vtkIdType InputVersion = 0;
    vtkIdType MotionVersion = 0;
    double Size = 0;
  };

  void TakeGrid(vtkUnstructuredGrid* grid, const Geometry::Options& options,
    const std::string& geometryKey, const WholeSurface* whole, State& next,
    morph::Monitor& monitor);
  static void FindFaces(vtkUnstructuredGrid* grid, State& next, morph::Monitor& monitor);
  /// Adds the faces of baffles and sheets.
  static void AddInner(State& next, morph::Monitor& monitor);
  bool AreLast(const std::vector<morph::Index>& faces, std::size_t number) const;
  static void TakeFaces(const WholeSurface& whole, State& next);
  void TakeSurface(vtkPolyData* surface, const Geometry::Options& options,
    const std::string& geometryKey, State& next, morph::Monitor& monitor);

  State Kept;
  int Classified = 0;
  vtkIdType Versions = 0;
};
}
