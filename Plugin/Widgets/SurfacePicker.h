// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfacePicker_h
#define SurfacePicker_h

#include <pqPropertyWidget.h>

#include <QString>
#include <QStringList>

#include <memory>

class QLabel;
class SurfaceHighlight;

/// A button that ticks, in a list of surfaces, those on which the selection in the view lies;
/// ticked surfaces are highlighted until they are applied. It is the widget of a ProxyProperty that
/// takes a selection (panel_widget="surface_picker"), whose hint names the properties that go with
/// it:
///
///     <SurfacePicker list="Surfaces" port="PickPort" picked="PickedSurfaces"/>
///
/// list: the ticked names; port: the output that is selected, -1 for the input; picked: the names
/// that the filter finds. The filter does the work, and a script sets the same properties.
class SurfacePicker : public pqPropertyWidget
{
  Q_OBJECT
  typedef pqPropertyWidget Superclass;

public:
  SurfacePicker(vtkSMProxy* filter, vtkSMProperty* pick, QWidget* parent = nullptr);
  ~SurfacePicker() override;

  void select() override;
  void deselect() override;

public Q_SLOTS:
  void setView(pqView* view) override;

private Q_SLOTS:
  void addSelected();
  void updateHighlight();

private:
  QString propertyName(const char* role) const;
  QStringList pickedNames(vtkSMProxy* selection, int port);

  QLabel* Message;
  std::unique_ptr<SurfaceHighlight> Highlight;
};

#endif
