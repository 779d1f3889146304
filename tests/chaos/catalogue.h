#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "api.h"

namespace affskel::chaos {

/// Where the programs under test are.
struct Programs {
  std::string server, worker, client;
  std::string preload;  ///< our own library
};

/// What the jobs compute: a shape and how it is eroded.
struct Recipe {
  const char* name;
  std::vector<std::string> shape;  ///< of `affskel-client make`
  std::uint64_t points;
  const char* directions;
  v1::Minimum minimum;
  /// Of jobs of which there are many one that is soon derived: the default one takes longer than their fields.
  v1::Operator skeleton = v1::OPERATOR_UNSPECIFIED;

  /// What its field is fetched as.
  v1::ArtifactKind field_kind() const {
    return minimum == v1::MINIMUM_INFIMUM ? v1::ARTIFACT_KIND_REFINED : v1::ARTIFACT_KIND_FIELD;
  }
};

/// Recipes by size: half a second of one core, some hundredths, next to nothing; one of half a second that is spent on
/// the infimum over all directions.
constexpr std::size_t kLongTorus = 0, kLongBody = 1, kMedium = 2, kTiny = 3, kInfimum = 4;
const std::vector<Recipe>& recipes();

/// What an undisturbed service makes of a recipe.
struct Reference {
  std::string field;
  std::string skeleton;
};

/// Meshes, submissions of them, and the undisturbed results.  Thread-safe once the references are set.
class Catalogue {
 public:
  /// Makes the meshes with the client.
  /// @param dir for files.
  Catalogue(const Programs& programs, const std::string& dir);

  /// A new submission.  The mesh's text differs by a comment from all others, so that the server cannot
  /// answer with an earlier job's field; the geometry, and so the field, is the recipe's.
  /// @param name unique.
  Submission next(std::size_t recipe, const std::string& name) const;

  const Reference& reference(std::size_t recipe) const { return references_.at(recipe); }
  void set_reference(std::size_t recipe, Reference reference) { references_[recipe] = std::move(reference); }
  /// The field as text from the worker's `compute`, without any server.
  std::string computed_text(const Programs& programs, std::size_t recipe) const;

 private:
  std::string dir_;
  std::vector<std::string> meshes_;
  std::map<std::size_t, Reference> references_;
};

}  // namespace affskel::chaos
