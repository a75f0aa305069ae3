// SPDX-License-Identifier: BSD-3-Clause
#include <vtkMPIController.h>
#include <vtkNew.h>

#include <gtest/gtest.h>

int main(int argc, char** argv)
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testing::InitGoogleTest(&argc, argv);
  int failed = RUN_ALL_TESTS();
  int any = failed;
  controller->AllReduce(&failed, &any, 1, vtkCommunicator::MAX_OP);
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return any;
}
