// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceTable_h
#define SurfaceTable_h

#include <pqPropertyWidget.h>

#include <QColor>
#include <QHash>
#include <QString>
#include <QStringList>
#include <QVector>

#include <memory>

class QComboBox;
class QLabel;
class QLineEdit;
class QMenu;
class QTreeWidget;
class QTreeWidgetItem;
class SurfaceHighlight;
class pqOutputPort;

/// The surfaces of a filter, one row each, with their color in the view, faces and area, and a role
/// to choose: a ticked surface moves; the others follow, stay, slide or are free. A choice holds
/// for all selected rows. Surfaces that move come first, then those that the file names, then the
/// others by number; curves are below a row that shows them.
///
/// It is the widget of the list of moving surfaces (panel_widget="SurfaceTable"), whose hint names
/// the other properties of the filter:
///
///     <SurfaceTable stays="FixedSurfaces" slides="SlidingSurfaces" free="FreeSurfaces"
///                   moving="Moving" sizes="SurfaceSizes"
///                   pick="Pick" port="PickPort" picked="PickedSurfaces"/>
///
/// stays, slides, free: lists of names, which scripts set, too. moving: what moves; a tick sets it
/// to its first value, the list. sizes: name, number of faces and area. What is selected in the
/// view, on the filter's input or on an output, selects the rows of the surfaces that it lies on:
/// pick takes the selection, port the number of the output or -1, and picked has the names.
/// Selected rows, and changes that are not applied, are highlighted in the view.
class SurfaceTable : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  SurfaceTable(vtkSMProxy* filter, vtkSMProperty* moves, QWidget* parent = nullptr);
  ~SurfaceTable() override;

  void apply() override;
  void reset() override;
  void select() override;
  void deselect() override;

public Q_SLOTS:
  void setView(pqView* view) override;

protected:
  /// A press on a role, and with the right button anywhere, opens the choice of roles.
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void fillLater();
  void pickRows(pqOutputPort* port);
  void addSelected();
  void highlight();

private:
  /// In the order of the choice.
  enum Role
  {
    Moves,
    Follows,
    Stays,
    Slides,
    Free
  };
  struct Surface
  {
    QString Name, Faces, Area;
    QColor Chip; ///< not valid: the view has none
    bool IsCurve;
    int Rank;   ///< 0 moves, 1 named by the file, 2 a surface, 3 a curve
    int Number; ///< of an unnamed one
  };

  vtkSMProperty* named(const char* role) const;
  vtkSMProperty* listOf(Role role) const;
  QStringList namesOf(Role role) const;
  /// Of those that do not follow.
  QHash<QString, Role> roles() const;
  QVector<Surface> surfaces() const;

  void makeRows(const QVector<Surface>& surfaces);
  void fill();
  void hideRows();
  void openRoles(const QPoint& place);
  void setRole(const QStringList& names, Role role);
  QStringList selectedNames() const;
  void selectNames(const QStringList& names);
  QStringList pickedNames(vtkSMProxy* selection, int port);
  void say(const QString& message);

  QComboBox* What;
  QLineEdit* Search;
  QTreeWidget* Rows;
  QMenu* Roles;
  QLabel* Message;
  std::unique_ptr<SurfaceHighlight> Highlight;
  bool AreCurvesShown = false;
  bool IsFilling = false;
  bool IsDue = false; ///< fill()
};

#endif
