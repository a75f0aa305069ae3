// SPDX-License-Identifier: BSD-3-Clause
#ifndef LiveDrag_h
#define LiveDrag_h

#include <QObject>
#include <QPointer>

#include <vtkSmartPointer.h>
#include <vtkWeakPointer.h>

#include <string>
#include <vector>

class pqPipelineSource;
class pqPropertiesPanel;
class pqPropertyWidget;
class pqView;
class vtkPVXMLElement;
class vtkSMProperty;
class vtkSMProxy;
class vtkSMRepresentationProxy;

/// A drag in the window that the filter's result follows, where the filter's property LiveDrag is
/// on. Each step goes to the filter at once, without Apply. On release there is one Apply, so that
/// the drag is one step for undo and one change in a trace.
///
/// The hint WhileDragging of LiveDrag says what is different in between: properties of the filter
/// get the values of its elements `Property`, and the output `port` is shown in place of output 0.
/// On release all is as it was.
class LiveDrag : public QObject
{
  Q_OBJECT
public:
  /// `widget`: of the filter's panel; the parent.
  explicit LiveDrag(pqPropertyWidget* widget);
  ~LiveDrag() override;

  /// Starts a drag of `properties` of `moved`, which is the filter or belongs to it. Returns
  /// whether the filter follows: LiveDrag is on, and the filter has been applied.
  bool begin(vtkSMProxy* moved, const std::vector<std::string>& properties);
  bool isRunning() const { return this->Running; }
  /// Passes the values in the panel to the filter, and updates the data that the views show. Draws
  /// the views, too, unless `draws` is false: what is dragged in a view does that itself.
  void follow(bool draws);
  void end();

private:
  using Values = std::vector<double>;
  struct SavedProperty
  {
    vtkSmartPointer<vtkSMProperty> Property;
    Values Before;
  };
  struct Shown
  {
    QPointer<pqView> View;
    vtkWeakPointer<vtkSMProxy> Hidden, InPlace;
  };

  pqPropertyWidget* Widget;
  bool Running = false;
  vtkSmartPointer<vtkSMProxy> Moved;
  std::vector<SavedProperty> Dragged; ///< with their values at the start
  std::vector<SavedProperty> Changed; ///< of the filter, while dragging
  std::vector<Shown> Views;

  vtkSMProxy* filter() const;
  pqPipelineSource* source() const;
  vtkPVXMLElement* hint() const;
  pqPropertiesPanel* panel() const;
  /// Stops or lets through what tells the panel of changes, which Auto Apply would apply.
  void blockPanel(bool block);
  void changeProperties();
  void showInPlace();
  void restore();
};

#endif
