// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkVersionMacros.h>

/// What differs between the VTK releases this module builds with: every test of VTK_VERSION_NUMBER
/// is here.
namespace morph::filters::Version
{
/// True once the user asked this algorithm, or one upstream, to stop.
inline bool AbortRequested(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220817)
  return algorithm->CheckAbort();
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}

/// Keeps the executive from emptying the output of an execution that was aborted.
inline void KeepAbortedOutput([[maybe_unused]] vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220817)
  algorithm->SetAbortOutput(false);
#endif
}
}
