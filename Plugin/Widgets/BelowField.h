// SPDX-License-Identifier: BSD-3-Clause
#ifndef BelowField_h
#define BelowField_h

class QWidget;

/// Puts a row below what a widget of the panel shows, and lets it be as narrow as the panel. The
/// widget's own fields keep their parent, by which tests and shortcuts find them.
void putBelow(QWidget* widget, QWidget* row);

#endif
