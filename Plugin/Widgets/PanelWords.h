// SPDX-License-Identifier: BSD-3-Clause
#ifndef PanelWords_h
#define PanelWords_h

class QString;

/// A message in the words of the panel: the name of a property, in backquotes, becomes its label,
/// "TargetReach" for instance "Target Reach".
QString inPanelWords(const QString& message);

#endif
