// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/Su2File.h"

#include "Files/ReadFile.h"
#include "Formats/TextFile.h"

#include <algorithm>

namespace morph::io
{
namespace
{
class Su2File : public TextFile
{
public:
  explicit Su2File(const std::string& path)
    : TextFile(path)
  {
    this->addPart(path, "");
    this->parse();
  }

private:
  struct Element
  {
    std::uint8_t type = 0;
    std::vector<Index> nodes;
    std::size_t at = 0; ///< in the text
  };

  std::string_view text() const { return this->parts_[0].text; }
  /// Splits the next line with content, comments removed, into fields_. Throws at the end.
  void nextFields(Lines& lines, const char* what);
  Index countOf(Span value) const;
  void takePoints(Lines& lines, Index count);
  Element takeElement(Lines& lines, const char* what);
  void takeMarker(Lines& lines, Index count, std::vector<Element>& faces);
  void addCell(const Element& element, Index number);
  void parse();

  std::vector<Span> fields_;
  std::size_t dimension_ = 3; ///< 2: the mesh is in the plane z = 0
};

/// The part of a line before a comment.
Span withoutComment(std::string_view text, Span span)
{
  const std::size_t percent = span.of(text).find('%');
  return { span.begin, percent == std::string_view::npos ? span.end : span.begin + percent };
}

int nodesOf(Index type)
{
  switch (type)
  {
    case Vertex:
      return 1;
    case Line:
      return 2;
    case Triangle:
      return 3;
    case Quad:
    case Tetra:
      return 4;
    case Pyramid:
      return 5;
    case Wedge:
      return 6;
    case Hexahedron:
      return 8;
    default:
      return 0;
  }
}

void Su2File::nextFields(Lines& lines, const char* what)
{
  do
  {
    if (!lines.next())
    {
      this->fail(std::string("it ends where ") + what + " should follow.");
    }
    splitAtBlanks(this->text(), withoutComment(this->text(), lines.span()), this->fields_);
  } while (this->fields_.empty());
}

Index Su2File::countOf(Span value) const
{
  splitAtBlanks(this->text(), value, const_cast<Su2File*>(this)->fields_);
  if (this->fields_.empty())
  {
    this->failAt(0, value.begin, "a number should follow the equals sign.");
  }
  const Index count = this->integerAt(0, this->fields_[0]);
  if (count < 0 || count > static_cast<Index>(this->text().size()))
  {
    this->failAt(0, value.begin, "the number " + std::to_string(count) + " is out of range.");
  }
  return count;
}

void Su2File::takePoints(Lines& lines, Index count)
{
  for (Index i = 0; i < count; ++i)
  {
    this->nextFields(lines, "a point");
    if (this->fields_.size() < this->dimension_)
    {
      this->failAt(0, lines.span().begin,
        std::string("a point needs ") + (this->dimension_ == 2 ? "two" : "three") +
          " coordinates.");
    }
    NodePlace place; // none for the third coordinate of a plane mesh, which stays 0
    std::array<double, 3> x = {};
    for (std::size_t j = 0; j < this->dimension_; ++j)
    {
      place.numbers[j] = placeOf(this->fields_[j]);
      x[j] = this->numberAt(0, this->fields_[j]);
    }
    this->mesh_.addNode(i, x[0], x[1], x[2]);
    this->places_.push_back(place);
  }
}

Su2File::Element Su2File::takeElement(Lines& lines, const char* what)
{
  this->nextFields(lines, what);
  Element element;
  element.at = lines.span().begin;
  const Index type = this->integerAt(0, this->fields_[0]);
  const auto count = static_cast<std::size_t>(nodesOf(type));
  if (count == 0 || this->fields_.size() < count + 1)
  {
    this->failAt(0, element.at,
      count == 0 ? "the element type " + std::to_string(type) + " is not known."
                 : "an element of type " + std::to_string(type) + " needs " +
                     std::to_string(count) + " nodes.");
  }
  element.type = static_cast<std::uint8_t>(type);
  for (std::size_t i = 1; i <= count; ++i)
  {
    element.nodes.push_back(this->integerAt(0, this->fields_[i]));
  }
  return element;
}

void Su2File::takeMarker(Lines& lines, Index count, std::vector<Element>& faces)
{
  for (Index i = 0; i < count; ++i)
  {
    faces.push_back(this->takeElement(lines, "an element of a marker"));
  }
}

void Su2File::addCell(const Element& element, Index number)
{
  for (const Index node : element.nodes)
  {
    if (node < 0 || node >= this->mesh_.nodes())
    {
      this->failAt(0, element.at, "there is no point " + std::to_string(node) + ".");
    }
  }
  this->mesh_.addCell(element.type, element.nodes, number);
}

void Su2File::parse()
{
  std::vector<Element> elements;
  std::vector<std::pair<std::string, std::vector<Element>>> markers;
  bool hasPoints = false;
  Lines lines(this->text());
  while (lines.next())
  {
    const Span span = withoutComment(this->text(), lines.span());
    const std::size_t equals = span.of(this->text()).find('=');
    if (equals == std::string_view::npos)
    {
      continue; // what belongs to keywords that are left alone
    }
    const std::string_view key = trimmed(span.of(this->text()).substr(0, equals));
    const Span value = trimmed(this->text(), { span.begin + equals + 1, span.end });
    if (key == "NDIME")
    {
      const Index dimension = this->countOf(value);
      if (dimension != 2 && dimension != 3)
      {
        this->failAt(0, span.begin, "a mesh has two or three dimensions.");
      }
      this->dimension_ = static_cast<std::size_t>(dimension);
    }
    else if (key == "NZONE" && this->countOf(value) != 1)
    {
      this->failAt(0, span.begin, "it has several zones. Write each into a file of its own.");
    }
    else if (key == "NPOIN")
    {
      if (hasPoints)
      {
        this->failAt(0, span.begin, "it has a second NPOIN: several zones are not supported.");
      }
      hasPoints = true;
      this->takePoints(lines, this->countOf(value));
    }
    else if (key == "NELEM")
    {
      for (Index i = this->countOf(value); i > 0; --i)
      {
        elements.push_back(this->takeElement(lines, "an element"));
      }
    }
    else if (key == "MARKER_TAG")
    {
      markers.push_back({ std::string(value.of(this->text())), {} });
    }
    else if (key == "MARKER_ELEMS")
    {
      if (markers.empty())
      {
        this->failAt(0, span.begin, "MARKER_ELEMS comes before its MARKER_TAG.");
      }
      // SEND_RECEIVE lists what partitions exchange: the lines after it belong to no surface.
      if (markers.back().first != "SEND_RECEIVE")
      {
        this->takeMarker(lines, this->countOf(value), markers.back().second);
      }
    }
  }
  if (!hasPoints || elements.empty())
  {
    this->fail(hasPoints ? "it has no elements (NELEM)." : "it has no points (NPOIN).");
  }
  for (const Element& element : elements)
  {
    this->addCell(element, this->mesh_.cells());
  }
  for (const auto& [name, faces] : markers)
  {
    for (const Element& face : faces)
    {
      const Index cell = this->mesh_.cells();
      this->addCell(face, -1);
      this->mesh_.set(name).cells.push_back(cell);
    }
  }
}
}

bool isSu2File(const std::string& path)
{
  return extensionOf(path) == ".su2";
}

std::unique_ptr<SolverFile> readSu2File(const std::string& path)
{
  return std::make_unique<Su2File>(path);
}
}
