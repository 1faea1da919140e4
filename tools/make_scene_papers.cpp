// SPDX-License-Identifier: MIT
// The papers' scenes. Light distances are what gives the papers' numbers of points at frame 0.
#include "make_scene_company.h"
#include "make_scene_rock.h"
#include "make_scene_scenes.h"
#include "make_scene_stage.h"

namespace tools {

using glm::vec3;

namespace {

constexpr vec3 kRed(0.5F, 0.1F, 0.07F), kBlue(0.1F, 0.22F, 0.38F), kGreen(0.16F, 0.3F, 0.12F),
    kOlive(0.2F, 0.24F, 0.1F);

// The light of the study: 0.5 m wide, views of 60 degrees from 2 m on.
void addStudyLight(GltfWriter& writer, const vec3& target, const vec3& towards, float distance,
                   double intensity) {
    addLight(writer,
             {target + distance * glm::normalize(towards), target, 0.5, intensity, false, 60, 2});
}

}  // namespace

void makeChallenger(GltfWriter& writer) {
    addFloor(writer, 6);
    addCompany(writer, {
                           .style = {.isArmoured = true, .hasLeftFist = true, .detail = 1.16F},
                           .actors = {{
                               .weapon = Weapon::pole,
                               .helmet = Helmet::crested,
                               .yawDeg = 25,
                               .startSeconds = 0.2F,
                               .cloth = kRed,
                               .hasCape = false,
                           }},
                           .triangleCount = 90007,
                       });
    addCamera(writer, {1.9F, 1.9F, 4.5F}, {0.5F, 1.3F, -0.2F}, 0.68F);
    addStudyLight(writer, {0, 1.3F, 0}, {-0.5F, 1.15F, 0.6F}, 5.206F, 400);
}

void makeVolund(GltfWriter& writer) {
    addFloor(writer, 7);
    addCompany(writer, {
                           .style = {.isArmoured = true, .hasLeftFist = true, .detail = 1.93F},
                           .actors = {{
                               .weapon = Weapon::hammer,
                               .helmet = Helmet::horned,
                               .yawDeg = 30,
                               .scale = 1.3F,
                               .startSeconds = 0.4F,
                               .cloth = {0.13F, 0.15F, 0.2F},
                           }},
                           .detail = 2,
                           .clothColumns = 64,
                           .helmetTriangles = 16000,
                           .triangleCount = 240186,
                       });
    addCamera(writer, {1.5F, 2.3F, 4.6F}, {0.35F, 1.2F, -0.2F}, 0.68F);
    addStudyLight(writer, {0, 1.4F, 0}, {-0.55F, 1.1F, 0.5F}, 5.669F, 480);
}

namespace {

Company warriors(float height) {
    return {
        .style = {.isArmoured = true, .hasLeftFist = true, .detail = 1.63F},
        .actors = {{
                       .weapon = Weapon::sword,
                       .helmet = Helmet::crested,
                       .place = {-0.75F, height, -0.1F},
                       .yawDeg = 78,
                       .startSeconds = 0.35F,
                       .cloth = kRed,
                   },
                   {
                       .weapon = Weapon::spear,
                       .helmet = Helmet::spiked,
                       .place = {1.15F, height, 0.1F},
                       .yawDeg = -88,
                       .scale = 1.02F,
                       .startSeconds = 0.9F,
                       .cloth = kBlue,
                   },
                   {
                       .weapon = Weapon::hammer,
                       .helmet = Helmet::horned,
                       .place = {0.1F, height, -1},
                       .yawDeg = 8,
                       .scale = 1.06F,
                       .startSeconds = 0.45F,
                       .cloth = kOlive,
                   }},
        .detail = 1.5F,
        .clothColumns = 56,
        .helmetTriangles = 12000,
        .triangleCount = 510523,
    };
}

}  // namespace

void makeWarriors(GltfWriter& writer) {
    addFloor(writer, 7);
    addCompany(writer, warriors(0));
    addCamera(writer, {1.0F, 2.4F, 4.2F}, {0.2F, 0.95F, -0.35F}, 0.68F);
    addStudyLight(writer, {0.1F, 1.1F, -0.3F}, {-0.5F, 1.15F, 0.45F}, 5.528F, 500);
}

void makeCliffside(GltfWriter& writer) {
    addFloor(writer, 9);
    const Company company = warriors(kCliffHeight);
    const size_t triangleCount = 672927 - company.triangleCount;
    const int stone = writer.addMaterial("rock", {0.42F, 0.37F, 0.32F}, 0.95F);
    addProp(writer, {{"name", "rock"}}, makeCliff(triangleCount), stone);
    addCompany(writer, company);
    addCamera(writer, {2.9F, 4.2F, 7.2F}, {0.5F, 1.85F, -0.3F}, 0.72F);
    addStudyLight(writer, {0, kCliffHeight, 0}, {-0.5F, 1.1F, 0.7F}, 8.379F, 800);
}

namespace {

// One of the [MVSS] sample's characters.
Actor soldier(Weapon weapon, Helmet helmet, float x, float z, float yawDeg, float startSeconds,
              const vec3& cloth) {
    return {
        .weapon = weapon,
        .helmet = helmet,
        .place = {x, 0, z},
        .yawDeg = yawDeg,
        .startSeconds = startSeconds,
        .cloth = cloth,
    };
}

void addSoldiers(GltfWriter& writer, const std::vector<Actor>& soldiers) {
    addCompany(writer, {
                           .style = {.hasLeftFist = true, .detail = 0.62F},
                           .actors = soldiers,
                           .detail = 0.3F,
                           .clothColumns = 9,
                           .helmetTriangles = 420,
                           .triangleCount = 6043 * soldiers.size(),
                       });
}

}  // namespace

void makeMvss2(GltfWriter& writer) {
    addFloor(writer, 6);
    addSoldiers(writer, {soldier(Weapon::sword, Helmet::crested, -0.55F, 0, 60, 0.4F, kRed),
                         soldier(Weapon::staff, Helmet::spiked, 1.0F, 0.1F, -30, 0.3F, kBlue)});
    addCamera(writer, {0.7F, 1.9F, 3.9F}, {0.25F, 0.95F, -0.2F}, 0.68F);
    addLight(writer, {{-2.3F, 4, 2}, {0, 1, 0}, 0.6, 280, true});
}

void makeMvss6(GltfWriter& writer) {
    addFloor(writer, 8);
    addSoldiers(writer, {soldier(Weapon::sword, Helmet::crested, -0.9F, 0.5F, 70, 0.4F, kRed),
                         soldier(Weapon::spear, Helmet::spiked, 0.95F, 0.6F, -75, 0.9F, kBlue),
                         soldier(Weapon::hammer, Helmet::horned, -0.1F, -0.5F, 10, 0.5F, kGreen),
                         soldier(Weapon::staff, Helmet::spiked, 1.7F, -0.6F, -20, 0.1F, kBlue),
                         soldier(Weapon::sword, Helmet::crested, -1.75F, -0.6F, 35, 1.2F, kRed),
                         soldier(Weapon::staff, Helmet::horned, 0.6F, -1.6F, 0, 0.7F, kGreen)});
    addCamera(writer, {0.8F, 2.6F, 5.2F}, {0.1F, 0.85F, -0.4F}, 0.68F);
    addLight(writer, {{-2.6F, 5, 2.6F}, {0, 1, -0.3F}, 0.8, 280, true});
}

}  // namespace tools
