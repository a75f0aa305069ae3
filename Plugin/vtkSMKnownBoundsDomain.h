// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMKnownBoundsDomain_h
#define vtkSMKnownBoundsDomain_h

#include <vtkSMBoundsDomain.h>

/// A BoundsDomain that waits for an input with points. In XML it is <KnownBoundsDomain>. ParaView's
/// gives its property the bounds of nothing before, numbers near 1e299.
class vtkSMKnownBoundsDomain : public vtkSMBoundsDomain
{
public:
  static vtkSMKnownBoundsDomain* New();
  vtkTypeMacro(vtkSMKnownBoundsDomain, vtkSMBoundsDomain);

  void Update(vtkSMProperty* requested) override;

protected:
  vtkSMKnownBoundsDomain() = default;
  ~vtkSMKnownBoundsDomain() override = default;

private:
  vtkSMKnownBoundsDomain(const vtkSMKnownBoundsDomain&) = delete;
  void operator=(const vtkSMKnownBoundsDomain&) = delete;
};

#endif
