// SPDX-License-Identifier: BSD-3-Clause
#ifndef SeriesColors_h
#define SeriesColors_h

#include "HintedResults.h"

#include <QSet>

/// Gives each line of a chart a color of its own where it is first shown: ParaView has seven, and
/// begins again. The axes get titles, and the legend the corner that lines which fall leave free. A
/// filter asks for it by a hint:
///
///     <SeriesColors port="1" x="Time" y="Minimum scaled Jacobian"/>
class SeriesColors : public HintedResults
{
  Q_OBJECT

public:
  SeriesColors()
    : HintedResults("SeriesColors", OfStates::Left) // a state brings its own colors
  {
  }
  ~SeriesColors() override = default;

protected:
  void updated(pqDataRepresentation* shown, vtkPVXMLElement* hint) override;

private:
  QSet<QObject*> Known; ///< charts that have their colors
};

#endif
