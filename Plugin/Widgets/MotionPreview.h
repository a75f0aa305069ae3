// SPDX-License-Identifier: BSD-3-Clause
#ifndef MotionPreview_h
#define MotionPreview_h

#include "SurfaceHighlight.h"

#include <vtkSmartPointer.h>

#include <QStringList>

class pqView;
class vtkSMProxy;

/// Shows the motion that the panel of a filter describes, before it is applied: the surfaces that
/// move as a ghost at their new place, and arrows to there.
class MotionPreview
{
public:
  /// `filter`: as Morph Mesh; see vtkDisplacementAlgorithm::CopyMovedSurfaces() for its properties.
  explicit MotionPreview(vtkSMProxy* filter);
  ~MotionPreview();

  /// Takes the values in the panel. Returns whether they differ from those that are applied.
  bool takeValues();
  /// With the values that are taken; `names`: of the surfaces.
  void show(pqView* view, const QStringList& names);
  void hide();

private:
  MotionPreview(const MotionPreview&) = delete;
  void operator=(const MotionPreview&) = delete;

  vtkSMProxy* Filter;
  vtkSmartPointer<vtkSMProxy> Motion; ///< a filter without inputs, with the values of the panel
  SurfaceHighlight Ghost;
};

#endif
