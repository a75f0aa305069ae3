// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSolverFileWriter
 * @brief   writes a solver's own file again, with nothing but its coordinates changed
 *
 * The file OriginalFileName is copied to FileName byte by byte. The coordinates of nodes that moved
 * are replaced; those of other nodes keep their very text. Exodus II and CGNS files are written by
 * their libraries, into the copy. Field widths, line ends, comments, order
 * and all that is no coordinate stay. Documentation/SolverFiles.md has the formats.
 *
 * The input is the grid of a vtkSolverFileReader with other points: any filters may have changed
 * it that keep the points and their array `NodeNumber` (the global ids). Its cells and other arrays
 * have no effect. It may have blocks, as with SetsAsBlocks: those with the same node give it the
 * same coordinates.
 *
 * The file is written as a whole, or the old one stays: after an error, on a full disk and after a
 * kill. FileName may be OriginalFileName.
 *
 * Errors: node numbers that are missing, doubled, or not those of the file; coordinates that are
 * not finite, or that the format has no room for; what vtkSolverFileReader refuses. Write() returns
 * 0 then, and writes nothing.
 *
 * A mesh of another reader has global ids in place of `NodeNumber`. It is refused where that reader
 * has added the displacements of an Exodus II file: its points less `MorphDisplacement` are not
 * those of the file. If no filter has morphed it, and its points are those of the file plus the
 * displacements of a time step, these become the coordinates.
 *
 * @sa vtkSolverFileReader
 */
#ifndef vtkSolverFileWriter_h
#define vtkSolverFileWriter_h

#include "vtkMeshMorphingFiltersIOModule.h" // for export macro

#include <vtkWriter.h>

class vtkDataObject;

class VTKMESHMORPHINGFILTERSIO_EXPORT vtkSolverFileWriter : public vtkWriter
{
public:
  static vtkSolverFileWriter* New();
  vtkTypeMacro(vtkSolverFileWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write, of the same extension as the original. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The file to copy. Empty, the default: the one that the input's field data `SolverFile` names.
   */
  vtkSetFilePathMacro(OriginalFileName);
  vtkGetFilePathMacro(OriginalFileName);
  ///@}

  ///@{
  /**
   * Whether signals that end the program (SIGINT, SIGTERM and the like) first remove the temporary
   * file. For command-line programs. Default off.
   */
  vtkSetMacro(HandleSignals, bool);
  vtkGetMacro(HandleSignals, bool);
  vtkBooleanMacro(HandleSignals, bool);
  ///@}

  /**
   * The largest difference between a coordinate of the input and what the last Write() wrote, in
   * the unit of the points. 0 where the format holds all digits; -1 before and after an error.
   */
  vtkGetMacro(LargestRounding, double);

  /**
   * The number of coordinates that the last Write() has changed, of three a node. All else is that
   * of the original. -1 before and after an error.
   */
  vtkGetMacro(ChangedCoordinates, vtkIdType);

  /**
   * Throws nothing and writes nothing: the reason why a copy of `original` cannot be written to
   * `name`, by their extensions and the folder's rights; empty where it can.
   */
  static std::string WhyNot(const char* original, const char* name);

protected:
  vtkSolverFileWriter();
  ~vtkSolverFileWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkSolverFileWriter(const vtkSolverFileWriter&) = delete;
  void operator=(const vtkSolverFileWriter&) = delete;

  void WriteCopy(vtkDataObject* input);

  char* FileName = nullptr;
  char* OriginalFileName = nullptr;
  bool HandleSignals = false;
  double LargestRounding = -1;
  vtkIdType ChangedCoordinates = -1;
};

#endif
