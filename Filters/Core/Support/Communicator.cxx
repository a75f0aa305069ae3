// SPDX-License-Identifier: BSD-3-Clause
#include "Support/Communicator.h"

#include "Support/ReproducibleSum.h"

#include <algorithm>
#include <utility>

namespace morph
{
CopiedRows::~CopiedRows() = default;

void CopiedRows::add(Points&) const
{
}

double CopiedRows::dot(const Points& a, const Points& b, Monitor& monitor) const
{
  return morph::dot(a, b, monitor);
}

const std::vector<Index>& CopiedRows::countedElsewhere() const
{
  static const std::vector<Index> none;
  return none;
}

void CopiedRows::update(Points& rows) const
{
  rows(this->countedElsewhere(), allColumns).setZero();
  this->add(rows);
}

void CopiedRows::collect(Points& rows) const
{
  this->add(rows);
  rows(this->countedElsewhere(), allColumns).setZero();
}

const CopiedRows& CopiedRows::alone()
{
  static const CopiedRows instance;
  return instance;
}

Communicator::~Communicator() = default;

void Communicator::together(const std::function<void()>& work) const
{
  work();
}

std::vector<Index> Communicator::idsOf(const std::vector<Index>& nodes) const
{
  return nodes;
}

double Communicator::sum(double value) const
{
  return value;
}

double Communicator::minimum(double value) const
{
  return value;
}

void Communicator::sum(double*, int) const
{
}

void Communicator::maximum(double*, int) const
{
}

void Communicator::spread(std::vector<Index>&) const
{
}

std::unique_ptr<CopiedRows> Communicator::rows() const
{
  return std::make_unique<CopiedRows>();
}

std::unique_ptr<Communicator> Communicator::part(const std::vector<Index>&) const
{
  return std::make_unique<Communicator>();
}

std::vector<std::string> Communicator::gatherTexts(const std::vector<std::string>& texts) const
{
  std::vector<double> characters;
  for (const std::string& text : texts)
  {
    characters.insert(characters.end(), text.begin(), text.end());
    characters.push_back(0);
  }
  std::vector<std::string> result;
  std::string text;
  for (const double character : this->gather(characters))
  {
    if (character != 0)
    {
      text += static_cast<char>(character);
    }
    else if (std::find(result.begin(), result.end(), text) == result.end())
    {
      result.push_back(std::exchange(text, {}));
    }
    else
    {
      text.clear();
    }
  }
  return result;
}

Points Communicator::gather(const Points& rows, const std::vector<Index>& nodes) const
{
  return rows(nodes, allColumns);
}

Index Communicator::join(std::vector<Index>& ofNode) const
{
  return ofNode.empty() ? 0 : 1 + *std::max_element(ofNode.begin(), ofNode.end());
}

std::vector<Index> Communicator::numbersOf(
  const std::vector<Index>&, const std::vector<Index>&) const
{
  return {};
}

std::shared_ptr<LinearSolver> Communicator::makeSolver(bool) const
{
  return nullptr;
}

std::shared_ptr<CellPieces> Communicator::cut(const Mesh&, int, Monitor&) const
{
  return nullptr;
}

const Communicator& Communicator::alone()
{
  static const Communicator instance;
  return instance;
}
}
