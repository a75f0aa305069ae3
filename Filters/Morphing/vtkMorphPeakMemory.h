// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkMorphPeakMemory_h
#define vtkMorphPeakMemory_h

/// The most memory that this process has held since the object was made, more than it held then. On Linux; NaN elsewhere, and where
/// the system does not let a process set its peak back.
class vtkMorphPeakMemory
{
public:
  vtkMorphPeakMemory();
  /// Of 10^6 bytes.
  double Megabytes() const;

private:
  double Start;
};

#endif
