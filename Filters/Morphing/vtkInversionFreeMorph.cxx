// SPDX-License-Identifier: BSD-3-Clause
#include "vtkInversionFreeMorph.h"

#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Untangling/InversionFree.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkInversionFreeMorph);

namespace
{
/// The method of the initial guess; null where the guess is not a method of its own.
std::unique_ptr<morph::Morpher> guessMethod(int guess)
{
  switch (guess)
  {
    case vtkInversionFreeMorph::INITIAL_GUESS_LBWARP:
      return std::make_unique<morph::LogBarrierWarp>();
    case vtkInversionFreeMorph::INITIAL_GUESS_WEIGHTED_RESIDUAL:
      return std::make_unique<morph::WeightedResidual>();
    case vtkInversionFreeMorph::INITIAL_GUESS_SIMPLEX_LINEAR:
      return std::make_unique<morph::SimplexLinear>();
    case vtkInversionFreeMorph::INITIAL_GUESS_SIMPLEX_NATURAL_NEIGHBOR:
      return std::make_unique<morph::SimplexNaturalNeighbor>();
    default:
      return nullptr;
  }
}
}

vtkInversionFreeMorph::vtkInversionFreeMorph()
{
  this->Validity = VALIDITY_SUB_STEP;
  this->Certify = true;
}

vtkInversionFreeMorph::~vtkInversionFreeMorph() = default;

std::unique_ptr<morph::Morpher> vtkInversionFreeMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::InversionFree>();
  if (auto method = guessMethod(this->InitialGuess))
  {
    morpher->setMethod(std::move(method));
  }
  return morpher;
}

std::string vtkInversionFreeMorph::PrepareOptions()
{
  return guessMethod(this->InitialGuess) ? std::to_string(this->InitialGuess) : "";
}

void vtkInversionFreeMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  using Morpher = morph::InversionFree;
  auto& own = static_cast<Morpher&>(morpher);
  if (!guessMethod(this->InitialGuess))
  {
    own.setStart(
      this->InitialGuess == INITIAL_GUESS_REST ? Morpher::Start::Rest : Morpher::Start::FemWarp);
  }
  own.setTarget(this->TargetShape == TARGET_SHAPE_INITIAL ? morph::TargetConstruction::Initial
                : this->TargetShape == TARGET_SHAPE_IDEAL ? morph::TargetConstruction::IdealSkew
                                                          : morph::TargetConstruction::Stretched);
  own.setRaising(this->ImproveWorst);
  own.setMinimizer(this->LowMemory ? morph::FoldoverContinuation::Minimizer::LimitedMemoryBfgs
                                   : morph::FoldoverContinuation::Minimizer::Newton);
}

void vtkInversionFreeMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "InitialGuess: " << this->InitialGuess << "\n";
  os << indent << "TargetShape: " << this->TargetShape << "\n";
  os << indent << "ImproveWorst: " << this->ImproveWorst << "\n";
  os << indent << "LowMemory: " << this->LowMemory << "\n";
}
