// SPDX-License-Identifier: MIT
// The papers' scenes. Light distances are what gives the papers' numbers of points at frame 0.
#include "make_scene_company.h"
#include "make_scene_rock.h"
#include "make_scene_scenes.h"
#include "make_scene_stage.h"

namespace tools {

using glm::vec3;

namespace {

// The light of the study: 0.5 m wide, views of 60 degrees from 2 m on.
void addStudyLight(GltfWriter& writer, const vec3& target, const vec3& towards, float distance,
                   double intensity) {
    addLight(writer,
             {target + distance * glm::normalize(towards), target, 0.5, intensity, false, 60, 2});
}

}  // namespace

void makeChallenger(GltfWriter& writer) {
    addFloor(writer, 6);
    addCompany(
        writer,
        {{true, true, 1.16F},
         {{Weapon::pole, Helmet::crested, {0, 0, 0}, 25, 1, 0.2F, {0.5F, 0.1F, 0.07F}, false}},
         1,
         40,
         8000,
         90007});
    addCamera(writer, {1.9F, 1.9F, 4.5F}, {0.5F, 1.3F, -0.2F}, 0.68F);
    addStudyLight(writer, {0, 1.3F, 0}, {-0.5F, 1.15F, 0.6F}, 5.206F, 400);
}

void makeVolund(GltfWriter& writer) {
    addFloor(writer, 7);
    addCompany(
        writer,
        {{true, true, 1.93F},
         {{Weapon::hammer, Helmet::horned, {0, 0, 0}, 30, 1.3F, 0.4F, {0.13F, 0.15F, 0.2F}, true}},
         2,
         64,
         16000,
         240186});
    addCamera(writer, {1.5F, 2.3F, 4.6F}, {0.35F, 1.2F, -0.2F}, 0.68F);
    addStudyLight(writer, {0, 1.4F, 0}, {-0.55F, 1.1F, 0.5F}, 5.669F, 480);
}

namespace {

Company warriors(float height) {
    return {{true, true, 1.63F},
            {{Weapon::sword,
              Helmet::crested,
              {-0.75F, height, -0.1F},
              78,
              1,
              0.35F,
              {0.5F, 0.1F, 0.07F},
              true},
             {Weapon::spear,
              Helmet::spiked,
              {1.15F, height, 0.1F},
              -88,
              1.02F,
              0.9F,
              {0.1F, 0.22F, 0.35F},
              true},
             {Weapon::hammer,
              Helmet::horned,
              {0.1F, height, -1.0F},
              8,
              1.06F,
              0.45F,
              {0.2F, 0.24F, 0.1F},
              true}},
            1.5F,
            56,
            12000,
            510523};
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

void addMvss(GltfWriter& writer, std::vector<Actor> actors) {
    const size_t count = 6043 * actors.size();
    addCompany(writer, {{false, true, 0.62F}, std::move(actors), 0.3F, 9, 420, count});
}

const vec3 kRed(0.5F, 0.1F, 0.07F), kBlue(0.1F, 0.22F, 0.4F), kGreen(0.16F, 0.3F, 0.12F);

}  // namespace

void makeMvss2(GltfWriter& writer) {
    addFloor(writer, 6);
    addMvss(writer, {{Weapon::sword, Helmet::crested, {-0.55F, 0, 0}, 60, 1, 0.4F, kRed},
                     {Weapon::staff, Helmet::spiked, {0.75F, 0, 0.1F}, -30, 1, 0.3F, kBlue}});
    addCamera(writer, {0.7F, 1.9F, 3.9F}, {0.15F, 0.95F, -0.2F}, 0.68F);
    addLight(writer, {{-2.3F, 4, 2}, {0, 1, 0}, 0.6, 280, true});
}

void makeMvss6(GltfWriter& writer) {
    addFloor(writer, 8);
    addMvss(writer, {{Weapon::sword, Helmet::crested, {-0.9F, 0, 0.5F}, 70, 1, 0.4F, kRed},
                     {Weapon::spear, Helmet::spiked, {0.85F, 0, 0.6F}, -75, 1, 0.9F, kBlue},
                     {Weapon::hammer, Helmet::horned, {-0.1F, 0, -0.5F}, 10, 1.05F, 0.5F, kGreen},
                     {Weapon::staff, Helmet::spiked, {1.7F, 0, -0.6F}, -20, 1, 0.1F, kBlue},
                     {Weapon::sword, Helmet::crested, {-1.75F, 0, -0.6F}, 35, 1, 1.2F, kRed},
                     {Weapon::staff, Helmet::horned, {0.6F, 0, -1.6F}, 0, 1, 0.7F, kGreen}});
    addCamera(writer, {0.8F, 2.6F, 5.2F}, {0.1F, 0.85F, -0.4F}, 0.68F);
    addLight(writer, {{-2.6F, 5, 2.6F}, {0, 1, -0.3F}, 0.8, 280, true});
}

}  // namespace tools
