// SPDX-License-Identifier: BSD-3-Clause
// One execution of vtkMorphShapes, and what is kept from one to the next.
#pragma once

#include "vtkMorphShapes.h"

#include "Private/Data/Results.h"
#include "Private/Options.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Shapes/Designs.h"
#include "Private/Shapes/ShapeModes.h"
#include "Private/Shapes/WeightRanges.h"
#include "Support/Monitor.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkType.h>

#include <string>
#include <utility>
#include <vector>

class vtkDataObject;
class vtkInformationVector;
class vtkPolyData;
class vtkUnstructuredGrid;

class vtkMorphShapes::vtkInternals
{
public:
  morph::filters::Results Results{ morph::filters::ResultTables::vtkMorphShapes() };
  morph::filters::ShapeModes Modes;
  morph::filters::Ports Ports;
  morph::filters::WeightRanges Ranges; ///< of the last execution
  vtkNew<vtkDoubleArray> ValidWeights; ///< of Ranges, as they were last asked for
  std::vector<double> Weights;         ///< of the last execution; empty where it had no result
  morph::filters::Designs Designs;
  vtkIdType Rows = 0;  ///< of the table, as of the last update of the information
  vtkIdType Row = 0;   ///< that the outputs are asked for
  double Time = 0;     ///< of Row
  morph::Points Moved; ///< kept for its memory: its content has no effect

  explicit vtkInternals(vtkMorphShapes* filter)
    : Ports(filter)
    , Filter(filter)
  {
  }

  /// `isDistributed`: all processes have pieces of the mesh, and call this.
  void Morph(vtkUnstructuredGrid* grid, bool isDistributed, vtkInformationVector* boundaries,
    vtkDataObject* table, vtkInformationVector* outputs, morph::Monitor& monitor);
  /// Writes the undeformed surface after an error, of a mesh that may not have been taken.
  void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const;
  /// The row of the table at Time.
  vtkIdType RowOf(vtkIdType rows) const;

private:
  /// What the fields were solved from. A weight that is dragged solves nothing, and does not match
  /// the boundaries again.
  struct Source
  {
    morph::MorphShapesOptions Options;
    std::vector<std::string> Names;
    std::vector<int> Motions;
    /// With their times; none where these are not known.
    std::vector<std::pair<vtkDataObject*, vtkMTimeType>> Boundaries;

    bool operator==(const Source& other) const
    {
      return this->Options == other.Options && this->Names == other.Names &&
             this->Motions == other.Motions && this->Boundaries == other.Boundaries;
    }
  };

  vtkMorphShapes* Filter;
  Source SolvedFrom;
  morph::Index Prescribed = 0; ///< nodes, of SolvedFrom

  Source SourceOf(vtkInformationVector* boundaries) const;
  morph::filters::ShapeModes::Options Options() const;
  std::vector<morph::filters::ShapeModes::Shape> Shapes(vtkInformationVector* boundaries) const;
  void Solve(vtkInformationVector* boundaries, morph::Monitor& monitor);
  void Write(vtkUnstructuredGrid* grid, const std::vector<double>& weights,
    vtkInformationVector* outputs, morph::Monitor& monitor);
  /// The present weights: the filter's, or those of the table's row.
  std::vector<double> PresentWeights(
    std::size_t shapes, vtkDataObject* table, morph::Monitor& monitor);
  void FindRanges(const std::vector<double>& weights, morph::Monitor& monitor);
  std::vector<std::string> Names(std::size_t number) const;
  void WriteShapes(const std::vector<double>& weights, vtkUnstructuredGrid* output) const;
};
