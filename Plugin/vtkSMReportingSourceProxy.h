// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMReportingSourceProxy_h
#define vtkSMReportingSourceProxy_h

#include <vtkSMSourceProxy.h>

/// A source whose information properties follow its data. In XML it is <ReportingSourceProxy>.
/// ParaView 5.11 fetches these properties when its panel for the source is made, and would continue
/// to show the numbers of the first Apply.
///
/// Where the filter has no number (NaN) the property has its default, -1, as MinScaledJacobian
/// without a result, and the panel hides its row (Widgets/KnownResult.h). NaN differs from itself,
/// so the panel would take it for a change by the user at each Apply. It would write it into Python
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
