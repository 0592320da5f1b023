#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hires::base {

/// Finds packages of ROS as rospack does: below the folders of ROS_PACKAGE_PATH, by the <name> in
/// their package.xml, whatever their folder is called; a package of manifest.xml is called what its
/// folder is. So are folders above a file, and packages beside the one that holds it, which need no
/// variable. Reads the variable when it is made, and each folder once. Not for several threads.
class PackageFinder {
 public:
  PackageFinder();

  /// Folders of that package, best first: those on ROS_PACKAGE_PATH in its order, then those that
  /// hold one of the folders `near`, then those beside them.
  std::vector<std::string> FoldersOf(const std::string& package,
                                     const std::vector<std::string>& near) const;

  /// The file or folder that package://<package>/<path> means.
  /// @param near  folders of the files that name it.
  /// @throws ConfigError: it names nothing inside a package; there is no such package; the package
  /// is there and the file is not. It says where was looked, what comes nearest and what to do.
  std::string Find(const std::string& uri, const std::vector<std::string>& near) const;

 private:
  /// Packages below a folder: name and folder, in order of folders.
  using Packages = std::vector<std::pair<std::string, std::string>>;

  const Packages& PackagesBelow(const std::filesystem::path& top) const;
  std::vector<std::string> NamesNear(const std::vector<std::string>& near) const;
  [[noreturn]] void FailNoPackage(const std::string& uri, const std::string& package,
                                  const std::vector<std::string>& near) const;

  std::string variable_;           // value of ROS_PACKAGE_PATH
  std::vector<std::string> tops_;  // its folders
  mutable std::map<std::string, Packages> packages_;
};

/// What a package in this folder is called; "" where there is neither package.xml nor manifest.xml.
std::string PackageNameIn(const std::filesystem::path& folder);

}  // namespace hires::base
