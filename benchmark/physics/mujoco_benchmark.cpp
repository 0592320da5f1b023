// The pepper mill on a moving plate in MuJoCo, to know how fast is fast. Elliptic friction cones,
// 1 kHz, everything else as MuJoCo has it by default.
#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace {

constexpr int kSettle = 500;   // steps
constexpr int kPeriod = 2000;  // steps of one swing to and fro
constexpr double kPi = 3.14159265358979323846;

enum class Support { kPlate, kPlane };

std::string RoomXml(bool has_room) {
  if (!has_room) return "";
  std::string xml = "<geom type='plane' size='50 50 1' pos='0 0 -0.3462'/>";
  for (int i = 0; i < 60; ++i) {
    std::array<char, 200> box{};
    std::snprintf(box.data(), box.size(),
                  "<geom type='box' size='0.25 0.25 0.35' pos='%g %g 0.0038' euler='0 0 %g'/>",
                  1.5 + i % 8, -3.5 + i / 8, 5.73 * i);
    xml += box.data();
  }
  return xml;
}

/// A heavy plate (or plane) on a slide whose speed is set every step, and the mill on it.
std::string SceneXml(Support support, bool is_multiccd, bool has_room) {
  const std::string ground =
      support == Support::kPlate
          ? "<geom type='box' size='0.125 0.329 0.0025' pos='0 0 -0.0025' "
            "mass='1e6' friction='0.8 0.005 0.0001'/>"
          : "<geom type='box' size='0.1 0.1 0.1' pos='0 0 -5' mass='1e6' contype='0' "
            "conaffinity='0'/>";
  const std::string plane = support == Support::kPlane
                                ? "<geom type='plane' size='5 5 1' friction='0.8 0.005 0.0001'/>"
                                : "";
  return "<mujoco><compiler inertiafromgeom='auto'/>"
         "<option timestep='0.001' cone='elliptic'><flag multiccd='" +
         std::string(is_multiccd ? "enable" : "disable") + "'/></option><worldbody>" + plane +
         RoomXml(has_room) + "<body name='plate'><joint name='slide' type='slide' axis='1 0 0'/>" +
         ground +
         "</body><body name='mill' pos='0 0 0.137'><freejoint/>"
         "<geom type='cylinder' size='0.037 0.137' mass='0.14' friction='0.8 0.005 0.0001'/>"
         "</body></worldbody></mujoco>";
}

struct Free {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, Free>;
using DataPtr = std::unique_ptr<mjData, Free>;

ModelPtr Load(const std::string& xml, std::string* error) {
  auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  mj_makeEmptyFileVFS(vfs.get(), "scene.xml", static_cast<int>(xml.size()));
  std::memcpy(vfs->filedata[0], xml.data(), xml.size());
  std::array<char, 500> text{};
  ModelPtr model(mj_loadXML("scene.xml", vfs.get(), text.data(), static_cast<int>(text.size())));
  *error = text.data();
  mj_deleteVFS(vfs.get());
  return model;
}

void Drive(const mjModel* model, mjData* data, int step) {
  data->qvel[0] = 0.3 * std::sin(2.0 * kPi * step / kPeriod);
  mj_step(model, data);
}

void Swing(benchmark::State& state, Support support, bool is_multiccd, bool has_room) {
  std::string error;
  const ModelPtr model = Load(SceneXml(support, is_multiccd, has_room), &error);
  if (model == nullptr) return state.SkipWithError(error.c_str());
  const DataPtr data(mj_makeData(model.get())), settled(mj_makeData(model.get()));
  for (int i = 0; i < kSettle; ++i) mj_step(model.get(), data.get());
  mj_copyData(settled.get(), model.get(), data.get());
  int step = kPeriod;
  for (auto _ : state) {
    if (step == kPeriod) {
      mj_copyData(data.get(), model.get(), settled.get());
      step = 0;
    }
    Drive(model.get(), data.get(), step++);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["contacts"] = data->ncon;
}

void BM_MujocoPlateMulticcd(benchmark::State& state) { Swing(state, Support::kPlate, true, false); }
BENCHMARK(BM_MujocoPlateMulticcd);

void BM_MujocoPlateMulticcdInRoom(benchmark::State& state) {
  Swing(state, Support::kPlate, true, true);
}
BENCHMARK(BM_MujocoPlateMulticcdInRoom);

void BM_MujocoPlateSingleContact(benchmark::State& state) {
  Swing(state, Support::kPlate, false, false);
}
BENCHMARK(BM_MujocoPlateSingleContact);

/// The plane stands still: MuJoCo's planes cannot move. What moves is a plate below it.
void BM_MujocoPlane(benchmark::State& state) { Swing(state, Support::kPlane, false, false); }
BENCHMARK(BM_MujocoPlane);

}  // namespace
