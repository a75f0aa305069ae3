// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkSMKeptArraySelectionDomain_h
#define vtkSMKeptArraySelectionDomain_h

#include <vtkSMArraySelectionDomain.h>

/// An ArraySelectionDomain whose property keeps its value when the list of names changes. In XML it
/// is <KeptArraySelectionDomain>. ParaView 6.1's ArraySelectionDomain then takes back what was set
/// before the names were known, as a script or a state does.
class vtkSMKeptArraySelectionDomain : public vtkSMArraySelectionDomain
{
public:
  static vtkSMKeptArraySelectionDomain* New();
  vtkTypeMacro(vtkSMKeptArraySelectionDomain, vtkSMArraySelectionDomain);

protected:
  vtkSMKeptArraySelectionDomain();
  ~vtkSMKeptArraySelectionDomain() override = default;

private:
  vtkSMKeptArraySelectionDomain(const vtkSMKeptArraySelectionDomain&) = delete;
  void operator=(const vtkSMKeptArraySelectionDomain&) = delete;
};

#endif
