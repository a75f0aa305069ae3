// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMReportingSourceProxy_h
#define vtkSMReportingSourceProxy_h

#include <vtkSMSourceProxy.h>

/// A source whose information properties follow its data, in XML <ReportingSourceProxy>. ParaView
/// 5.11 fetches them when its panel for the source is made, and would go on showing the numbers of
/// the first Apply.
///
/// Where the filter has no number (NaN) the property has its default: NaN differs from itself, so
/// that the panel would take it for changed by the user at each Apply, and write it into Python
/// traces, which cannot be played then.
class vtkSMReportingSourceProxy : public vtkSMSourceProxy
{
public:
  static vtkSMReportingSourceProxy* New();
  vtkTypeMacro(vtkSMReportingSourceProxy, vtkSMSourceProxy);

protected:
  vtkSMReportingSourceProxy() = default;
  ~vtkSMReportingSourceProxy() override = default;

  void PostUpdateData(bool usingCache) override;
  void UpdatePropertyInformationInternal(vtkSMProperty* property) override;

private:
  vtkSMReportingSourceProxy(const vtkSMReportingSourceProxy&) = delete;
  void operator=(const vtkSMReportingSourceProxy&) = delete;
};

#endif
