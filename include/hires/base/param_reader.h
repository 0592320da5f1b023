#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hires::base {

/// What a value must satisfy, with the words for the error message.
template <typename T>
struct Bound {
  std::function<bool(const T&)> holds;
  std::string wanted;  ///< "between 0.1 and 600"
};

Bound<double> Between(double lower, double upper);  ///< both ends included; NaN never fits
Bound<double> Positive();
Bound<int> Between(int lower, int upper);
Bound<std::string> OneOf(std::vector<std::string> choices);

/// The word that fits among those that YAML reads as this bool: off, no or false, and on, yes or
/// true. Nothing where none fits.
std::optional<std::string> WordOf(bool value, const Bound<std::string>& bound);

/// Reads one YAML map into parameter structs. Every key must be read and every key that is read
/// must be there, so that a typo stops the program at start-up.
/// All errors are base::ConfigError: "file: path.to.key is 7, wanted ...; line 12".
class ParamReader {
 public:
  static ParamReader FromFile(const std::string& path);
  /// `where` stands for the file name in messages.
  static ParamReader FromString(const std::string& yaml, const std::string& where);

  double Get(const std::string& key, const Bound<double>& bound);
  int Get(const std::string& key, const Bound<int>& bound);
  std::string Get(const std::string& key, const Bound<std::string>& bound);
  bool GetBool(const std::string& key);
  std::string GetString(const std::string& key);  ///< any text, also empty
  std::vector<double> GetNumbers(const std::string& key, std::size_t size);  ///< finite numbers
  /// @param wanted  for the message where it is something else.
  std::vector<std::string> GetStrings(const std::string& key,
                                      const std::string& wanted = "a list of text");
  /// A list of pairs of numbers, also as text that holds one ("[[1, 2], [3, 4]]"); nothing where it
  /// is something else.
  std::optional<std::vector<std::pair<double, double>>> FindPairs(const std::string& key,
                                                                  const Bound<double>& bound);

  bool Has(const std::string& key) const;
  /// All that are missing in one error. Keys of maps within are "path.to.key".
  void RequireKeys(const std::vector<std::string>& keys) const;
  ParamReader Sub(const std::string& key);                   ///< a nested map
  std::vector<ParamReader> SubList(const std::string& key);  ///< a list of maps
  std::vector<std::string> Keys() const;                     ///< in the order of the file

  std::string Canonical() const;  ///< as YAML text without comments, for hashes

  /// @throws ConfigError naming the first key that was not asked for, here or in any Sub().
  void RejectUnknownKeys() const;

  /// An error about `key` in the words of this reader, for checks across keys.
  [[noreturn]] void Fail(const std::string& key, const std::string& what) const;

 private:
  struct Map;  // the map and what was asked of it; the YAML library is slow to compile
  explicit ParamReader(std::shared_ptr<Map> map);

  std::shared_ptr<Map> map_;  // copies share it
};

}  // namespace hires::base
