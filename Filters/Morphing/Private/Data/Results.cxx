// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Results.h"

#include "Private/Data/Output.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ostream>
#include <stdexcept>
#include <utility>

namespace morph::filters
{
namespace
{
[[noreturn]] void refuse(const char* name)
{
  throw std::logic_error(std::string("Results.txt has no such row of this type: ") + name);
}
}

Results::Results(const std::vector<ResultRow>& rows)
{
  for (const ResultRow& row : rows)
  {
    this->Entries.push_back({ row, Without(row) });
  }
}

Results::Value Results::Without(const ResultRow& row)
{
  const char* none = row.None ? row.None : "0";
  switch (row.Kind)
  {
    case ResultKind::Double:
      return std::strtod(none, nullptr);
    case ResultKind::Text:
      return std::string(none);
    default:
      return static_cast<vtkIdType>(std::strtoll(none, nullptr, 10));
  }
}

void Results::Reset()
{
  this->Counts.clear();
  for (Entry& entry : this->Entries)
  {
    entry.IsSet = false;
    if (entry.Row.None)
    {
      entry.Result = Without(entry.Row);
    }
  }
}

std::size_t Results::IndexOf(const char* name) const
{
  const auto found = std::find_if(this->Entries.begin(), this->Entries.end(),
    [name](const Entry& entry) { return std::strcmp(name, entry.Row.Name) == 0; });
  if (found == this->Entries.end())
  {
    refuse(name);
  }
  return found - this->Entries.begin();
}

void Results::Keep(const char* name, Value value)
{
  Entry& entry = this->Entries[this->IndexOf(name)];
  if (entry.Result.index() != value.index())
  {
    refuse(name);
  }
  entry.Result = std::move(value);
  entry.IsSet = true;
}

template <typename Type>
const Type& Results::Get(const char* name) const
{
  const Type* value = std::get_if<Type>(&this->Entries[this->IndexOf(name)].Result);
  if (!value)
  {
    refuse(name);
  }
  return *value;
}

void Results::SetNumber(const char* name, double value)
{
  this->Keep(name, value);
}

void Results::SetInteger(const char* name, vtkIdType value)
{
  this->Keep(name, value);
}

void Results::SetText(const char* name, std::string value)
{
  this->Keep(name, std::move(value));
}

void Results::SetCounts(std::vector<morph::Statistic> counts)
{
  this->Counts = std::move(counts);
}

void Results::Set(const morph::Quality& quality)
{
  this->SetNumber("MinScaledJacobian", quality.minimum);
  this->SetNumber("MeanScaledJacobian", quality.mean);
  this->SetInteger("InvertedCells", quality.inverted);
  this->SetInteger("DegenerateCells", quality.degenerate);
  this->SetInteger("WorstCellId", quality.worstCell);
}

void Results::Set(const Quality::Judged& judged)
{
  this->SetInteger("InvertedBefore", judged.Before);
  this->SetInteger("NewInvertedCells", judged.Added);
}

void Results::Set(const morph::CertificateReport& report)
{
  this->SetInteger("CertifiedCells", report.certified);
  this->SetInteger("UncertifiedCells", report.inverted);
  this->SetInteger("UndecidedCells", report.undecided);
}

double Results::Number(const char* name) const
{
  return this->Get<double>(name);
}

vtkIdType Results::Integer(const char* name) const
{
  return this->Get<vtkIdType>(name);
}

const std::string& Results::Text(const char* name) const
{
  return this->Get<std::string>(name);
}

vtkIdType Results::Count(const char* name) const
{
  for (const morph::Statistic& count : this->Counts)
  {
    if (count.name == name)
    {
      return static_cast<vtkIdType>(count.value);
    }
  }
  return 0;
}

void Results::Write(vtkDataObject* output) const
{
  std::vector<const Entry*> written;
  for (const Entry& entry : this->Entries)
  {
    const bool isThere = entry.IsSet || entry.Row.Always || entry.Row.Kind == ResultKind::Counts;
    if (entry.Row.Place > 0 && isThere)
    {
      written.push_back(&entry);
    }
  }
  std::sort(written.begin(), written.end(),
    [](const Entry* a, const Entry* b) { return a->Row.Place < b->Row.Place; });
  for (const Entry* entry : written)
  {
    const char* name = entry->Row.Name;
    switch (entry->Row.Kind)
    {
      case ResultKind::Double:
        Output::AddField(output, name, std::get<double>(entry->Result));
        break;
      case ResultKind::Int:
        Output::AddField(output, name, static_cast<int>(std::get<vtkIdType>(entry->Result)));
        break;
      case ResultKind::Id:
        Output::AddField(output, name, std::get<vtkIdType>(entry->Result));
        break;
      case ResultKind::Text:
        Output::AddField(output, name, std::get<std::string>(entry->Result).c_str());
        break;
      case ResultKind::Counts:
        for (const morph::Statistic& count : this->Counts)
        {
          Output::AddField(output, count.name.c_str(), static_cast<vtkIdType>(count.value));
        }
        break;
    }
  }
}

void Results::Print(std::ostream& os, vtkIndent indent) const
{
  for (const Entry& entry : this->Entries)
  {
    if (entry.Row.Kind == ResultKind::Counts)
    {
      for (const morph::Statistic& count : this->Counts)
      {
        os << indent << count.name << ": " << count.value << "\n";
      }
      continue;
    }
    os << indent << entry.Row.Name << ": ";
    std::visit([&os](const auto& value) { os << value << "\n"; }, entry.Result);
  }
}
}
