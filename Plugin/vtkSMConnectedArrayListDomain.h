// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMConnectedArrayListDomain_h
#define vtkSMConnectedArrayListDomain_h

#include <vtkSMArrayListDomain.h>

/// An ArrayListDomain that offers nothing before its input is connected. In XML it is
/// <ConnectedArrayListDomain>. ParaView 5.11's ArrayListDomain then offers its none_string, and the
/// panel lets it report that it does not find that array.
class vtkSMConnectedArrayListDomain : public vtkSMArrayListDomain
{
public:
  static vtkSMConnectedArrayListDomain* New();
  vtkTypeMacro(vtkSMConnectedArrayListDomain, vtkSMArrayListDomain);

protected:
  vtkSMConnectedArrayListDomain() = default;
  ~vtkSMConnectedArrayListDomain() override = default;

  int ReadXMLAttributes(vtkSMProperty* prop, vtkPVXMLElement* element) override;

private:
  vtkSMConnectedArrayListDomain(const vtkSMConnectedArrayListDomain&) = delete;
  void operator=(const vtkSMConnectedArrayListDomain&) = delete;
};

#endif
