// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMConnectedArrayListDomain_h
#define vtkSMConnectedArrayListDomain_h

#include <vtkSMArrayListDomain.h>

/// An ArrayListDomain, in XML <ConnectedArrayListDomain>, that offers nothing before its input is
/// connected. ParaView 5.11's own one offers its none_string then, and the panel has it report that
/// it cannot tell where that array is.
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
