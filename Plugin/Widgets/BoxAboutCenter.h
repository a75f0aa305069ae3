// SPDX-License-Identifier: BSD-3-Clause
#ifndef BoxAboutCenter_h
#define BoxAboutCenter_h

#include <QObject>

#include <array>

class pqInteractivePropertyWidget;
class vtkBoundingBox;
class vtkPVXMLElement;
class vtkSMProperty;
class vtkSMProxy;

/// Lets the box of a transform turn and scale about the center of what moves. ParaView's transform
/// does so about the origin, and places its box around the whole input.
///
/// The box is placed around the surfaces that are ticked, so that it turns about their center when
/// it is dragged. With nothing ticked there is no box: it would take the mouse from the view. Where
/// a region moves, whose own box may be around the whole input as well, it is a bit larger than the
/// input. When a rotation or a scale is typed, the translation is changed
/// with it, so that the center stays where it is, or the one that the filter is given.
///
/// Where the filter takes the numbers about the center themselves, the box is hidden: ParaView
/// draws it about the origin.
class BoxAboutCenter : public QObject
{
  Q_OBJECT
public:
  /// `hint`: its attributes name properties of the filter: list, with the ticks, and sizes and
  /// bounds, with the names in the list and their boxes; moving: the value of the property Moving
  /// with which the list is used; region: the one with which a region is.
  BoxAboutCenter(pqInteractivePropertyWidget* box, vtkSMProxy* filter, vtkPVXMLElement* hint);
  ~BoxAboutCenter() override;

private Q_SLOTS:
  void placeLater();
  void place();
  void keepCenter();
  void hideWhereAboutCenter();

private:
  using Triple = std::array<double, 3>;
  struct Numbers
  {
    Triple Position, Rotation, Scale;
  };

  pqInteractivePropertyWidget* Box;
  vtkSMProxy* Filter;
  vtkSMProperty *List, *Sizes, *Bounds, *Moving;
  int MovingList = 0;    ///< of Moving
  int MovingRegion = -1; ///< of Moving
  Triple Middle{};       ///< of the box before it is moved
  Numbers Before{};
  bool IsOfNothing = false; ///< and hidden
  bool IsPlacing = false;

  vtkSMProperty* named(vtkPVXMLElement* hint, const char* role) const;
  Numbers read() const;
  Triple center() const;
  bool isAboutCenter() const;
  /// Around what is ticked; not valid where nothing is.
  vtkBoundingBox ticked() const;
  /// Whether the list says what moves, and nothing is ticked.
  bool isOfNothing(const vtkBoundingBox& box) const;
};

#endif
