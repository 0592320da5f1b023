#include "hires/translation/load_context.h"

#include "hires/robot/load_robot.h"
#include "hires/world/object_catalogue.h"

namespace hires::translation {
TranslatorContext LoadContext(const ContextFiles& files) {
  TranslatorContext context = MakeContext(
      world::LoadWorld(files.world), robot::LoadAnyRobot(files.robot),
      world::LoadCatalogueModels(files.objects),
      std::make_shared<const knowledge::Ontology>(knowledge::Ontology::FromFiles(files.ontology)));
  context.standing = files.standing;
  context.classify = files.classify;
  return context;
}

}  // namespace hires::translation
