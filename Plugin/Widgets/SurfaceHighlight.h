// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceHighlight_h
#define SurfaceHighlight_h

#include <vtkSmartPointer.h>

#include <QPointer>
#include <QStringList>

class pqView;
class vtkSMProxy;
class vtkSMSourceProxy;

/// Surfaces of a filter's list in a view, apart from its pipeline: as orange lines or, with a
/// motion, as a green ghost at the place to which that takes them, with arrows. The server cuts
/// them out (vtkListedSurfaces). Neither the source nor its representation is registered, so that
/// no browser, state or trace has them.
class SurfaceHighlight
{
public:
  /// `motion`: a filter that has the motion as its properties, and no inputs; null: none.
  explicit SurfaceHighlight(vtkSMProxy* filter, vtkSMProxy* motion = nullptr);
  ~SurfaceHighlight();

  /// Shows the surfaces and curves of these names, and no others. Does nothing in a view that has
  /// no place for it, as a chart.
  void show(pqView* view, const QStringList& names);
  void hide();

  /// A vtkListedSurfaces of the filter's list.
  static vtkSmartPointer<vtkSMSourceProxy> SourceOf(vtkSMProxy* filter);

private:
  SurfaceHighlight(const SurfaceHighlight&) = delete;
  void operator=(const SurfaceHighlight&) = delete;

  void create();

  vtkSMProxy* Filter;
  vtkSmartPointer<vtkSMProxy> Motion;
  vtkSmartPointer<vtkSMSourceProxy> Source;
  vtkSmartPointer<vtkSMProxy> Representation;
  QPointer<pqView> View; ///< that shows it, or null
};

#endif
