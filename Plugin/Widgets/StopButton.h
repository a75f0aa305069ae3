// SPDX-License-Identifier: BSD-3-Clause
#ifndef StopButton_h
#define StopButton_h

#include <QElapsedTimer>
#include <QObject>

class pqPipelineSource;
class vtkAlgorithm;
class vtkObject;

/// Makes the button beside the progress bar stop our filters. ParaView has it, but handles no
/// event while a filter executes, so that nobody can press it.
///
/// It is enabled once a filter has been at work for a second, in the built-in server alone: another
/// process hears of nothing before it is done. What is pressed elsewhere meanwhile does nothing, as
/// nobody waits for the answer. While a mouse button is held, as in a live drag, events are left in
/// the queue: letting go is what ends the drag.
class StopButton : public QObject
{
  Q_OBJECT

public:
  StopButton() = default;
  ~StopButton() override = default;

  void startup();
  void shutdown() {}

protected:
  bool eventFilter(QObject* receiver, QEvent* event) override;

private Q_SLOTS:
  void watch(pqPipelineSource* source);
  void started(vtkObject* filter);
  void progressed(vtkObject* filter);
  void ended(vtkObject* filter);
  void stop();

private:
  vtkAlgorithm* Running = nullptr; ///< between its start and its end
  QElapsedTimer Since;             ///< when it began, then when events were last handled
  bool IsOffered = false;          ///< whether the button is enabled
  bool IsLooking = false;          ///< whether events are handled now
};

#endif
