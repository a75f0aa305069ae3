// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceTable_h
#define SurfaceTable_h

#include <pqPropertyGroupWidget.h>

#include <QColor>
#include <QHash>
#include <QString>
#include <QStringList>
#include <QVector>

#include <memory>

class MotionPreview;
class QComboBox;
class QLabel;
class QLineEdit;
class QMenu;
class QTreeWidget;
class QTreeWidgetItem;
class SurfaceHighlight;
class pqOutputPort;
class vtkSMPropertyGroup;

/// The surfaces of a filter, one row each, with their color in the view, faces, area and shape, and
/// a role to choose; a narrow panel hides the shapes first, then areas and faces. A ticked surface
/// moves; the others follow, stay, slide or are free. A choice holds for all selected rows.
/// Surfaces that move come first, then those that the file names, then the others by number; curves
/// are below a row that shows them.
///
/// It is the widget of the group of the lists of names Surfaces, FixedSurfaces, SlidingSurfaces and
/// FreeSurfaces, which scripts set, too, and of Moving, which a tick sets to its first value, the
/// list (panel_widget="SurfaceTable"). The filter's SurfaceSizes has name, number of faces and area
/// of each, and SurfaceShapes name and shape. What is selected in the view, on the filter's input
/// or on an output, selects the rows of the surfaces that it lies on: Pick takes the selection,
/// PickPort the number of the output or -1, and PickedSurfaces has the names. Selected rows, and
/// changes that are not applied, are highlighted in the view, and a motion that is not applied is
/// shown (MotionPreview.h).
class SurfaceTable : public pqPropertyGroupWidget
{
  Q_OBJECT
  using Superclass = pqPropertyGroupWidget;

public:
  SurfaceTable(vtkSMProxy* filter, vtkSMPropertyGroup* group, QWidget* parent = nullptr);
  ~SurfaceTable() override;

  void apply() override;
  void reset() override;
  void select() override;
  void deselect() override;
  /// Of the motion that is not applied, until the panel changes again.
  void hidePreview();

  /// Adds the roles of the surface at a place of the view, in pixels from the left and the top, to
  /// `menu`, if the panel shows a table of the filter that is there, or of a filter of that.
  static void OfferRoles(QMenu* menu, pqView* view, const QPoint& place);

public Q_SLOTS:
  void setView(pqView* view) override;

protected:
  /// A press on a role, and with the right button anywhere, opens the choice of roles.
  bool eventFilter(QObject* object, QEvent* event) override;
  /// The first one of all widens the panel to its content.
  void showEvent(QShowEvent* event) override;

private Q_SLOTS:
  void fillLater();
  void pickRows(pqOutputPort* port);
  void addSelected();
  void highlight();
  void previewLater();

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
    QString Name, Faces, Area, Shape;
    QColor Chip; ///< not valid: the view has none
    bool IsCurve;
    int Rank;   ///< 0 moves, 1 named by the file, 2 a surface, 3 a curve
    int Number; ///< of an unnamed one
  };

  vtkSMProperty* named(const char* property) const;
  vtkSMProperty* listOf(Role role) const;
  QStringList namesOf(Role role) const;
  /// Whether the panel's list of what moves is another one than is applied.
  bool areMovesNew() const;
  /// Of those that do not follow.
  QHash<QString, Role> roles() const;
  QVector<Surface> surfaces() const;

  void makeRows(const QVector<Surface>& surfaces);
  void fill();
  void hideRows();
  /// The last ones before the role, in a panel that is too narrow for all.
  void hideColumns();
  void openRoles(const QPoint& place);
  void setRole(const QStringList& names, Role role);
  QStringList selectedNames() const;
  void selectNames(const QStringList& names);
  QStringList pickedNames(vtkSMProxy* selection, int port);
  /// The port of the filter's output that this is, -1 for its input, -2 for neither.
  int portOf(vtkSMProxy* source, int port) const;
  void addRoles(QMenu* menu, const QStringList& names);
  void preview();
  void say(const QString& message);

  QComboBox* What;
  QLineEdit* Search;
  QTreeWidget* Rows;
  QMenu* Roles;
  QLabel* Message;
  std::unique_ptr<SurfaceHighlight> Highlight;
  std::unique_ptr<MotionPreview> Preview;
  bool AreCurvesShown = false;
  bool IsFilling = false;
  bool IsDue = false;        ///< fill()
  bool IsPreviewDue = false; ///< preview()
};

#endif
