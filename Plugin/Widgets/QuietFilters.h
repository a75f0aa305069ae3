// SPDX-License-Identifier: BSD-3-Clause
#ifndef QuietFilters_h
#define QuietFilters_h

#include <QObject>

class pqPipelineSource;

/// Lets filters whose panel shows their messages (MessageList.h) say nothing else: no window of
/// messages opens over the view at each drag or step.
class QuietFilters : public QObject
{
  Q_OBJECT

public:
  QuietFilters() = default;
  ~QuietFilters() override = default;

  void startup();
  void shutdown() {}

private Q_SLOTS:
  void quiet(pqPipelineSource* source);
};

#endif
