// SPDX-License-Identifier: MIT
#include "make_scene_company.h"

#include <cstdio>
#include <optional>
#include <stdexcept>

#include "make_scene_arms.h"
#include "make_scene_fight.h"
#include "make_scene_stage.h"
#include "make_scene_walk.h"

namespace tools {

using glm::quat;
using glm::vec3;
using nlohmann::json;

namespace {

struct Metal {
    std::string_view name;
    vec3 colour;
    float roughness;
};
constexpr Metal kSteel{"blade", {0.55F, 0.56F, 0.6F}, 0.35F};
constexpr Metal kWood{"wood", {0.3F, 0.18F, 0.1F}, 0.75F};

// A rigid part under a joint.
struct Part {
    std::string_view name;
    Mesh mesh;
    Metal look;
    Joint joint;
    vec3 translation{0};
    quat rotation{1, 0, 0, 0};
};

// A sheet under a joint or, with `onPole`, in the right hand beside the pole.
struct Sheet {
    std::string_view name;
    Cloth cloth;
    bool onPole;
};

struct Outfit {
    std::vector<Part> parts;
    std::vector<Sheet> sheets;
    Clip clip;

    size_t triangleCount() const {
        size_t count = 0;
        for (const Part& part : parts) count += part.mesh.triangleCount();
        for (const Sheet& sheet : sheets) count += sheet.cloth.mesh.triangleCount();
        return count;
    }
};

float gripHeightOf(Weapon weapon) {
    switch (weapon) {
        case Weapon::sword:
            return kSwordGripHeight;
        case Weapon::spear:
            return 0.7F;
        case Weapon::hammer:
            return 0.55F;
        default:
            return kStaffGripHeight;
    }
}

Arms makeWeapon(Weapon weapon, float detail) {
    switch (weapon) {
        case Weapon::sword:
            return makeSword(detail);
        case Weapon::hammer:
            return makeHammer(detail);
        case Weapon::pole:
            return makePole(detail);
        default:
            return makeSpear(detail);
    }
}

bool isWalked(Weapon weapon) {
    return weapon == Weapon::pole || weapon == Weapon::staff;
}

Fight fightOf(Weapon weapon) {
    return weapon == Weapon::sword   ? Fight::sword
           : weapon == Weapon::spear ? Fight::spear
                                     : Fight::hammer;
}

void addArms(Outfit& outfit, const Arms& arms, std::string_view name, const Part& place) {
    for (const auto& [mesh, look] :
         {std::pair(&arms.steel, kSteel), std::pair(&arms.wood, kWood)}) {
        Part part = place;
        part.name = name;
        part.mesh = *mesh;
        part.look = look;
        outfit.parts.push_back(std::move(part));
    }
}

// On the forearm, so that it faces forward while the figure is on guard.
Part shieldPlace() {
    const Pose guard = fightGuard(Fight::sword);
    const vec3 facing = glm::normalize(vec3(0.25F, 0.12F, 0.95F));
    const quat toArm = glm::inverse(guard.rotations[kLowerArmL]);
    Part place{"", {}, kWood, kLowerArmL};
    place.rotation = glm::normalize(toArm * turn(15, vec3(0, 1, 0)) * turn(83, vec3(1, 0, 0)));
    place.translation = 0.15F * armDirectionL() + toArm * (0.055F * facing);
    return place;
}

Outfit makeOutfit(const Actor& actor, const Company& company) {
    Outfit outfit;
    Part hand{"", {}, kSteel, kHandR};
    hand.translation = barTranslation(gripHeightOf(actor.weapon));
    hand.rotation = barRotation();
    addArms(outfit, makeWeapon(actor.weapon, company.detail), "weapon", hand);
    if (actor.weapon == Weapon::sword)
        addArms(outfit, makeShield(company.detail), "shield", shieldPlace());
    const uint32_t columns = company.clothColumns;
    const bool hasFlag = actor.weapon == Weapon::pole;
    if (hasFlag) {
        addArms(outfit, makeScabbard(company.detail), "scabbard", {"", {}, kSteel, kHips});
        outfit.sheets.push_back(
            {"flag",
             makeFlag(columns, 3 * columns / 2, kPoleLength - 0.72F, kPoleLength - 0.06F, 1.05F),
             true});
    }
    if (actor.hasCape) outfit.sheets.push_back({"cape", makeCape(columns, 3 * columns / 2), false});
    outfit.clip = isWalked(actor.weapon) ? makeWalk(actor.startSeconds)
                                         : makeFight(fightOf(actor.weapon), actor.startSeconds);
    outfit.clip = repeat(outfit.clip, company.loops);
    return outfit;
}

void addSheet(GltfWriter& writer, const Sheet& sheet, const Actor& actor, int firstJoint,
              int animation, const Clip& clip) {
    int parent = firstJoint + kChest;
    if (sheet.onPole)
        parent = addUnder(writer, firstJoint + kHandR,
                          placedNode("flagPlace", barTranslation(kStaffGripHeight),
                                     barRotation() * turn(-75, vec3(0, 1, 0))));
    const auto& places = sheet.cloth.jointPositions;
    int first = 0;
    for (size_t link = 0; link < places.size(); ++link) {
        const vec3 origin = link == 0 ? vec3(0) : places[link - 1];
        parent = addUnder(writer, parent,
                          {{"name", std::string(sheet.name) + std::to_string(link)},
                           {"translation", toJson(places[link] - origin)}});
        if (link == 0) first = parent;
    }
    const int material = writer.addMaterial(sheet.name, actor.cloth, 0.9F);
    writer.document()["materials"][material]["doubleSided"] = true;
    const int mesh = writer.addClothMesh(sheet.name, sheet.cloth, material);
    const int skin = writer.addSkin(sheet.name, first, places);
    addUnder(writer, -1, {{"name", sheet.name}, {"mesh", mesh}, {"skin", skin}});
    writer.animateNodes(
        animation, clip.timesSeconds,
        waveCloth(sheet.cloth, clip.timesSeconds, clip.timesSeconds.back(), actor.startSeconds),
        first);
}

void addActor(GltfWriter& writer, const Actor& actor, const Outfit& outfit,
              const FigureBuffers& body, std::vector<FigureMaterial> looks, int animation) {
    json rootNode = placedNode("figure", actor.place, yaw(actor.yawDeg));
    rootNode["scale"] = toJson(vec3(actor.scale));
    const int root = addUnder(writer, -1, std::move(rootNode));
    const int firstJoint = addSkeleton(writer, root);
    for (FigureMaterial& look : looks)
        if (look.name == "gambeson" || look.name == "coat") look.baseColor = 0.8F * actor.cloth;
    const int mesh = writer.addFigureMesh("skin", body, looks);
    const int skin = writer.addSkin("figure", firstJoint);
    addUnder(writer, -1, {{"name", "skin"}, {"mesh", mesh}, {"skin", skin}});
    writer.animateFigure(animation, outfit.clip, firstJoint);
    for (const Part& part : outfit.parts) {
        const int material =
            writer.addMaterial(part.look.name, part.look.colour, part.look.roughness);
        addProp(writer, placedNode(part.name, part.translation, part.rotation), part.mesh, material,
                firstJoint + part.joint);
    }
    for (const Sheet& sheet : outfit.sheets)
        addSheet(writer, sheet, actor, firstJoint, animation, outfit.clip);
}

}  // namespace

void addCompany(GltfWriter& writer, const Company& company) {
    std::vector<Outfit> outfits;
    size_t carried = 0;
    for (const Actor& actor : company.actors) {
        outfits.push_back(makeOutfit(actor, company));
        carried += outfits.back().triangleCount() + company.helmetTriangles;
    }
    const auto fail = [&] {
        throw std::runtime_error("the figures cannot have " +
                                 std::to_string(company.triangleCount) + " triangles beside the " +
                                 std::to_string(carried) + " of what they carry");
    };
    if (carried >= company.triangleCount) fail();
    if ((company.triangleCount - carried) % 2 != 0) {
        // All but sheets is closed and so even: a sheet loses a corner
        auto& sheets = outfits.front().sheets;
        if (sheets.empty()) fail();
        sheets.front().cloth.mesh.indices.resize(sheets.front().cloth.mesh.indices.size() - 3);
        --carried;
    }
    // Bodies are equal: what does not divide evenly goes to the first helmet
    const size_t rest = (company.triangleCount - carried) % (2 * company.actors.size());
    FigureStyle style = company.style;
    style.triangleCount = (company.triangleCount - carried - rest) / company.actors.size();
    const Figure figure = makeFigure(style);
    const FigureBuffers body = writer.addFigureBuffers(figure);
    const int animation = writer.addAnimation("motion");
    for (size_t i = 0; i < outfits.size(); ++i) {
        const Actor& actor = company.actors[i];
        outfits[i].parts.push_back(
            {"helmet", makeHelmet(actor.helmet, company.helmetTriangles + (i == 0 ? rest : 0)),
             kSteel, kHead});
        addActor(writer, actor, outfits[i], body, figure.materials, animation);
        std::printf("%-12s %6zu triangles\n", "body", figure.skin.triangleCount());
    }
    std::printf("%-12s %6zu triangles\n", "all figures", company.triangleCount);
}

}  // namespace tools
