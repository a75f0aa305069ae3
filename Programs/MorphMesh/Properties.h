// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkMorphMesh;

/// The properties of the filters as options of the command line.
namespace morph_mesh
{
struct PropertyValue
{
  std::vector<double> numbers; ///< of a choice its number, of a flag 0 or 1
  std::string text;            ///< a name
};

/// A row of Filters/Morphing/Properties.ini.
struct Property
{
  enum class Kind
  {
    Number,
    Integer,
    Flag,
    Choice,
    Text,
    Names
  };
  std::string option; ///< "--target-reach"; empty: it can only be implied
  std::string name;
  std::string group;
  Kind kind;
  std::size_t count; ///< of numbers
  double least, most;
  std::vector<std::string> words;                           ///< of a choice
  std::vector<double> defaults;                             ///< of numbers
  std::vector<std::pair<std::string, std::string>> implied; ///< names and words of others
  std::string help;
  /// Whether the filter has the property; it then sets it.
  std::function<bool(vtkAlgorithm*, const PropertyValue&)> set;
};

/// All of them, in the order of the table. Made by cmake/properties.py.
const std::vector<Property>& properties();

/// Gives Morph Mesh the defaults of ParaView's Repair Mesh: a motion of zero, and the repair of all
/// inverted cells. Made by cmake/properties.py.
void setRepair(vtkMorphMesh* filter);

/// A message of a filter, in which `TargetReach` stands for that property, in the words of the
/// command line: --target-reach. Other words in backquotes stay.
std::string inOptions(const std::string& message);

/// How the help calls its value, "<x,y,z>" for instance; empty for a flag.
std::string valueName(const Property& property);
/// The words of a choice with commas between them; empty where it is none.
std::string wordsOf(const Property& property);
/// " Did you mean X?" of the name that is spelled most like `name`, case aside; empty if more than
/// `most` letters or any digit differ.
std::string didYouMean(
  const std::string& name, const std::vector<std::string>& names, std::size_t most);

/// The properties that a command line gives.
class GivenProperties
{
public:
  /// Adds a property of properties(), and those that it implies. Throws UsageError for a value that
  /// it does not accept, and where the property or one that it implies has another value already.
  void add(const Property& property, const std::string& text);
  /// As add(), by the name of a property, for an option that is not the property's own.
  void imply(const std::string& name, const std::string& word, const std::string& option);

  bool has(const std::string& name) const;
  /// Gives names of lists the case that they have in `listed`, if one there is the same but for
  /// case. Returns whether any has changed. Throws Failure for a name that is nearly one there.
  bool spell(const std::vector<std::string>& listed);
  /// As it is given; empty where it is not.
  std::string text(const std::string& name) const;
  double number(const std::string& name, double otherwise) const;
  /// Whether a number of it is 0.
  bool hasZero(const std::string& name) const;
  /// The option that gave or implied it.
  std::string giver(const std::string& name) const;
  /// All, for a record of what was given: "--method=FEMWARP ...".
  std::string all() const;

  /// Sets each but Method on the first of the filters that has it. Throws UsageError where none has
  /// one that was given; `without`: why not, for the message.
  void apply(const std::vector<vtkAlgorithm*>& filters, const std::string& without) const;

private:
  struct Given
  {
    const Property* property;
    PropertyValue value;
    std::string option; ///< that gave or implied it
    bool isImplied;
  };
  void take(const Given& given);
  const Given* find(const std::string& name) const;

  std::vector<Given> given_;
};
}
