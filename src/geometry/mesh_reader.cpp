#include "hires/geometry/mesh_reader.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <set>

#include "geometry/plain_gltf.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::geometry {
namespace {

constexpr std::size_t kMaxBytes = 64u << 20;
constexpr std::size_t kMaxTriangles = 500000;
constexpr double kMaxCoordinate = 1e4;  // [m]

/// Stands for an empty disk, so that a mesh cannot pull in other files.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

[[noreturn]] void Fail(const std::string& path, const std::string& what) {
  throw base::ConfigError(fmt::format("{}: {}", path, what));
}

/// "stl", "dae", "obj", "glb" or "gltf".
std::string FormatOf(const std::string& path) {
  static const std::set<std::string> read{".stl", ".dae", ".obj", ".glb", ".gltf"};
  std::string ending = base::ToLower(std::filesystem::path(path).extension().string());
  if (read.count(ending) == 0) {
    Fail(path,
         fmt::format("a mesh of type '{}' is not read; convert it to .stl, .dae, .obj or .glb",
                     ending));
  }
  return ending.substr(1);
}

void CheckScale(const std::string& path, const Eigen::Vector3d& scale) {
  if (scale.allFinite() && (scale.array() != 0.0).all()) return;
  Fail(path, fmt::format("its scale is ({}, {}, {}), wanted finite factors other than 0; 1 leaves "
                         "the mesh as it is",
                         scale.x(), scale.y(), scale.z()));
}

/// Files that are none of a mesh's, and what they are.
void RefuseOtherFiles(const std::string& path, const std::string& bytes) {
  if (bytes.find_first_not_of(" \t\r\n") == std::string::npos)
    Fail(path, "is empty, wanted a mesh; export it again");
  if (bytes.rfind("version https://git-lfs", 0) == 0) {
    Fail(path, "is a pointer of Git LFS and not the mesh; run `git lfs pull` in its repository");
  }
  base::RefuseUtf16(bytes, path);
}

/// What the importer says, with the file's name for the one that it makes up for bytes.
std::string Said(const Assimp::Importer& importer, const std::string& path,
                 const std::string& format) {
  const std::string made_up = "$$$___magic___$$$." + format;
  const std::string name = std::filesystem::path(path).filename().string();
  std::string said = importer.GetErrorString();
  for (std::size_t at = said.find(made_up); at != std::string::npos;
       at = said.find(made_up, at + name.size())) {
    said.replace(at, made_up.size(), name);
  }
  return said;
}

/// Of a node and those below it. Polygons count as what they are cut into, and meshes as often as
/// they are placed.
std::size_t NumTrianglesIn(const aiScene& scene, const aiNode& node) {
  std::size_t count = 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < part.mNumFaces; ++k)
      count += std::max(part.mFaces[k].mNumIndices, 2u) - 2u;
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    count += NumTrianglesIn(scene, *node.mChildren[i]);
  return count;
}

/// @param is_whole  Nodes and their names are not needed.
const aiScene& Import(Assimp::Importer* importer, const std::string& path,
                      const std::string& format, const std::string& bytes, bool is_whole) {
  importer->SetIOHandler(new NoFiles);  // the importer owns it
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // not ids
  importer->SetPropertyBool(AI_CONFIG_PP_FD_REMOVE, true);
  importer->SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // Normals and colours would keep corners at one place from being joined.
  importer->SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                               aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                   aiComponent_COLORS | aiComponent_TEXCOORDS |
                                   aiComponent_MATERIALS | aiComponent_TEXTURES);
  const aiScene* scene =
      importer->ReadFileFromMemory(bytes.data(), bytes.size(), 0u, format.c_str());
  // What follows takes ten times as long as reading.
  const std::size_t num_triangles = scene == nullptr || scene->mRootNode == nullptr
                                        ? 0
                                        : NumTrianglesIn(*scene, *scene->mRootNode);
  if (num_triangles > kMaxTriangles) {
    Fail(path, fmt::format("has {} triangles, at most {} are read; decimate it", num_triangles,
                           kMaxTriangles));
  }
  if (scene != nullptr) {
    scene = importer->ApplyPostProcessing(
        aiProcess_Triangulate | aiProcess_RemoveComponent |
        (is_whole ? static_cast<unsigned>(aiProcess_PreTransformVertices) : 0u) |
        aiProcess_JoinIdenticalVertices | aiProcess_FindDegenerates | aiProcess_SortByPType);
  }
  if (scene == nullptr) {
    Fail(path, fmt::format("no valid mesh: {}; export it again", Said(*importer, path, format)));
  }
  return *scene;
}

void Append(const aiMesh& part, const Eigen::Vector3d& scale, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh->vertices.push_back(scale.cwiseProduct(Eigen::Vector3d(p.x, p.y, p.z)));
  }
  const bool mirrored = scale.prod() < 0.0;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices != 3) continue;
    std::array<int, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = first + static_cast<int>(face.mIndices[k]);
    if (mirrored) std::swap(corners[1], corners[2]);
    mesh->triangles.push_back(corners);
  }
}

/// What is found of a submesh.
struct Search {
  std::string wanted;
  std::vector<std::string> names;  ///< that there are
  TriangleMesh mesh;
};

/// Takes the meshes of nodes that are called so, or that are called so themselves.
void Visit(const aiScene& scene, const aiNode& node, aiMatrix4x4 X_WParent, Search* search) {
  const aiMatrix4x4 X_WN = X_WParent * node.mTransformation;
  const std::string name = node.mName.C_Str();
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const std::string own = part.mName.C_Str();
    for (const std::string& met : {name, own}) {
      std::vector<std::string>& names = search->names;
      if (std::find(names.begin(), names.end(), met) == names.end()) names.push_back(met);
    }
    if (name != search->wanted && own != search->wanted) continue;
    const std::size_t first = search->mesh.vertices.size();
    Append(part, Eigen::Vector3d::Ones(), &search->mesh);
    for (std::size_t k = first; k < search->mesh.vertices.size(); ++k) {
      const Eigen::Vector3d& p = search->mesh.vertices[k];
      const aiVector3D moved =
          X_WN * aiVector3D(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
      search->mesh.vertices[k] = {moved.x, moved.y, moved.z};
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) Visit(scene, *node.mChildren[i], X_WN, search);
}

TriangleMesh PartOf(const aiScene& scene, const std::string& path, const Eigen::Vector3d& scale,
                    const Submesh& submesh) {
  Search search{submesh.name, {}, {}};
  if (scene.mRootNode != nullptr) Visit(scene, *scene.mRootNode, aiMatrix4x4(), &search);
  if (search.mesh.triangles.empty())
    Fail(path, base::UnknownName("submesh", submesh.name, search.names));
  Aabb bounds;
  for (const Eigen::Vector3d& p : search.mesh.vertices) bounds.Include(p);
  const Eigen::Vector3d middle = submesh.is_centred
                                     ? Eigen::Vector3d(0.5 * (bounds.lower + bounds.upper))
                                     : Eigen::Vector3d::Zero();
  for (Eigen::Vector3d& p : search.mesh.vertices) p = scale.cwiseProduct(p - middle);
  if (scale.prod() < 0.0) {
    for (auto& corners : search.mesh.triangles) std::swap(corners[1], corners[2]);
  }
  return std::move(search.mesh);
}

void CheckMesh(const std::string& path, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) Fail(path, "holds no triangles; export the solid, not its outline");
  for (const Eigen::Vector3d& p : mesh.vertices) {
    if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxCoordinate) continue;
    Fail(path, fmt::format("corner ({}, {}, {}) is not finite or beyond {} m; is the scale right "
                           "(meshes in mm want 0.001)?",
                           p.x(), p.y(), p.z(), kMaxCoordinate));
  }
}

}  // namespace

TriangleMesh ReadMesh(const std::string& path, const Eigen::Vector3d& scale,
                      const Submesh& submesh) {
  const std::string format = FormatOf(path);
  CheckScale(path, scale);
  std::string bytes = base::ReadTextFile(path, kMaxBytes);
  RefuseOtherFiles(path, bytes);
  if (format == "glb" || format == "gltf") bytes = PlainGltf(bytes, format == "glb", path);
  Assimp::Importer importer;
  const bool is_whole = submesh.name.empty();
  const aiScene& scene = Import(&importer, path, format, bytes, is_whole);
  TriangleMesh mesh;
  for (unsigned i = 0; is_whole && i < scene.mNumMeshes; ++i) {
    Append(*scene.mMeshes[i], scale, &mesh);
  }
  if (!is_whole) mesh = PartOf(scene, path, scale, submesh);
  CheckMesh(path, mesh);
  return mesh;
}

}  // namespace hires::geometry
