// SPDX-License-Identifier: BSD-3-Clause
#ifndef HintedResults_h
#define HintedResults_h

#include <QObject>

class pqDataRepresentation;
class pqRepresentation;
class vtkPVXMLElement;

/// Hears of new results in the window, of filters that ask for it by a hint. With the attribute
/// `port` that is for one output alone.
class HintedResults : public QObject
{
  Q_OBJECT

public:
  ~HintedResults() override = default;

  void startup();
  void shutdown() {}

protected:
  enum class OfStates
  {
    Heard,
    Left ///< what a loaded state shows is left as it is
  };
  /// `hint`: the element's name in the filter's hints.
  explicit HintedResults(const char* hint, OfStates ofStates = OfStates::Heard);

  virtual void updated(pqDataRepresentation* shown, vtkPVXMLElement* hint) = 0;

private Q_SLOTS:
  void added(pqRepresentation* representation);
  void dataUpdated();

private:
  const char* Hint;
  OfStates States;
};

#endif
