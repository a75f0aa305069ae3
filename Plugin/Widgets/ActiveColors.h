// SPDX-License-Identifier: BSD-3-Clause
#ifndef ActiveColors_h
#define ActiveColors_h

#include "HintedResults.h"

#include <QHash>

/// Keeps a filter's results colored in the window. ParaView chooses the colors when it first
/// shows an output. Where that had no scalars, or another array, later results would be white. A
/// filter asks for it by the hint <ActiveColors/>; its results are then colored by their active
/// scalars, unless the user has chosen an array that is there, or a solid color.
class ActiveColors : public HintedResults
{
  Q_OBJECT

public:
  ActiveColors()
    : HintedResults("ActiveColors")
  {
  }
  ~ActiveColors() override = default;

protected:
  void updated(pqDataRepresentation* representation, vtkPVXMLElement* hint) override;

private:
  void color(pqDataRepresentation* representation);

  QHash<QObject*, bool> HadScalars; ///< of representations
};

#endif
