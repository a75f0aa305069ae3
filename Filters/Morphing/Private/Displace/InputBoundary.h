// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/NamedSets.h"
#include "Private/Displace/Zones.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <set>
#include <string>
#include <vector>

class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
struct GatheredSurface;

/// The boundary of a filter's input, kept while the input stays the same. The input is a grid, or a
/// surface that was extracted from one before. Nodes are the input's points.
class InputBoundary : public morph::BoundaryModel
{
public:
  struct Options : Geometry::Options
  {
    std::set<std::string> Names;          ///< that are asked for
    const MergedBlocks* Blocks = nullptr; ///< that the input was merged from, or null
    /// Of a mesh on several MPI processes, or null. Its zones count then.
    const GatheredSurface* Whole = nullptr;
  };

  /// Copies the input, a grid or polygonal data; with Whole, its Grid. An unmodified input costs
  /// nothing. The geometry is reused where a modified input has the same boundary and the same
  /// arrays that define its geometry. Throws morph::Error as Geometry::Classify() does, for a grid
  /// without volume cells, and for a surface without polygons, MorphPointId or RestPosition. Then
  /// nothing is kept.
  void Update(vtkPointSet* input, const Options& options, morph::Monitor& monitor);

  /// The boundary as vtkClassifyBoundary writes it, at the input's points, with the input's arrays.
  vtkPolyData* Surface() const { return this->Written; }
  /// The node of each point of Surface(), ascending.
  const std::vector<morph::Index>& NodeOfPoint() const { return this->Nodes; }
  /// The face of each polygon of Surface(), and the cell id of the first polygon.
  const std::vector<morph::Index>& FaceOfPolygon() const { return this->Polygons; }
  morph::Index FirstPolygon() const;

  /// The parts of the input that can be zones.
  const std::vector<ListedZone>& Parts() const { return this->Listed; }

  /// How often the geometry was found so far.
  int ClassifyCount() const { return this->Classified; }

private:
  void TakeGrid(vtkUnstructuredGrid* grid, const Options& options, const std::string& key,
    morph::Monitor& monitor);
  void TakeSurface(vtkPolyData* surface, const Geometry::Options& options, const std::string& key,
    morph::Monitor& monitor);
  bool HasOuter(const morph::BoundaryFaces& outer) const;
  void TakePart(const GatheredSurface& part);
  void FindInnerSurfaces(vtkUnstructuredGrid* grid, std::vector<ListedZone> zones, bool sameMesh,
    morph::Monitor& monitor);
  /// Those of the names that inner surfaces have.
  std::set<std::string> Asked(const std::set<std::string>& names) const;

  std::vector<ListedZone> Listed;
  std::vector<morph::NamedNodes> Sets;
  std::vector<std::uint8_t> IsNamed; ///< #cells: those of named sets
  std::string GeometryKey;           ///< empty: nothing is kept
  vtkSmartPointer<vtkPolyData> Written;
  std::vector<morph::Index> Nodes, Polygons;
  const vtkPointSet* Input = nullptr; ///< compared, never used
  vtkMTimeType InputTime = 0;
  int Classified = 0;
  std::int64_t Versions = 0;
};
}
