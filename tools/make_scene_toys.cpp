// SPDX-License-Identifier: MIT
// [4DR] Toys: soldiers with skins, and a train, a carousel, a spinning top, balls and others on
// nodes, all in a loop of four seconds.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "make_scene_bear.h"
#include "make_scene_company.h"
#include "make_scene_exhibit.h"
#include "make_scene_fight.h"
#include "make_scene_scenes.h"
#include "make_scene_toybox.h"

namespace tools {

using glm::quat;
using glm::vec2;
using glm::vec3;
using nlohmann::json;

namespace {

constexpr size_t kTriangleCount = 263000, kSoldierTriangles = 84000;
constexpr float kCarouselHeight = 7.4F;

constexpr vec3 kRed(0.6F, 0.1F, 0.08F), kYellow(0.75F, 0.55F, 0.1F), kBlue(0.1F, 0.22F, 0.5F),
    kGreen(0.15F, 0.4F, 0.16F), kWhite(0.75F, 0.73F, 0.68F), kWood(0.5F, 0.33F, 0.18F);
constexpr vec3 kPaints[] = {kRed, kYellow, kBlue, kGreen, kWhite};

const vec3& paintOf(int number) {
    return kPaints[number % std::size(kPaints)];
}

const quat kUpright = glm::angleAxis(glm::half_pi<float>(), vec3(1, 0, 0));

void addSoldiers(GltfWriter& writer, Exhibit& exhibit) {
    Company company{
        .style = {.hasLeftFist = true, .detail = 1.05F},
        .actors = {{
                       .weapon = Weapon::sword,
                       .helmet = Helmet::crested,
                       .place = {-1.2F, 0, 6.4F},
                       .yawDeg = 75,
                       .scale = 2.3F,
                       .startSeconds = 0.4F,
                       .cloth = kRed,
                   },
                   {
                       .weapon = Weapon::staff,
                       .helmet = Helmet::spiked,
                       .place = {2.6F, 0, 5.6F},
                       .yawDeg = -60,
                       .scale = 2.3F,
                       .cloth = kBlue,
                   }},
        .detail = 1,
        .clothColumns = 24,
        .helmetTriangles = 5000,
        .loops = 2,
        .triangleCount = kSoldierTriangles,
    };
    addCompany(writer, company);
    exhibit.count(company.triangleCount, 0);
}

// A car of the train in its own space: it drives along +Z, wheels on y = 0.
void addCar(Toybox& box, int number, int place) {
    Mesh wheels, body;
    for (const float x : {-1.0F, 1.0F})
        for (const float z : {-0.55F, 0.55F})
            append(wheels, makeTorus(0.24F, 0.09F, 40, 14),
                   glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1)), {0.5F * x, 0.33F, z});
    append(body, makeBlock({0, 0.55F, 0}, {0.5F, 0.14F, 0.92F}, 0.04F));
    append(body, makeBar({0, 0.5F, -1.2F}, {0, 0.5F, -0.9F}, 0.06F, 12));
    if (number == 0) {
        append(body, makeBar({0, 1.1F, -0.3F}, {0, 1.1F, 0.95F}, 0.42F, 48));
        append(body, makeBlock({0, 1.35F, -0.55F}, {0.5F, 0.68F, 0.36F}, 0.04F));
        append(body, makeBlock({0, 2.1F, -0.55F}, {0.6F, 0.07F, 0.46F}, 0.03F));
        append(body, makeLathe({{0.14F, 0}, {0.13F, 0.4F}, {0.25F, 0.62F}, {0.2F, 0.64F}}, 36),
               yaw(0), {0, 1.45F, 0.65F});
    } else {
        for (const float side : {-1.0F, 1.0F}) {
            append(body, makeBlock({0.46F * side, 0.9F, 0}, {0.05F, 0.24F, 0.9F}, 0.02F));
            append(body, makeBlock({0, 0.9F, 0.86F * side}, {0.42F, 0.24F, 0.05F}, 0.02F));
        }
        Mesh load;
        for (const vec3& at : {vec3(0, 1.05F, 0.42F), vec3(0.05F, 1.08F, -0.42F)})
            append(load, makeSphere(0.4F, 40, 24), yaw(0), at);
        box.add("load", load, paintOf(number + 2), place, 60);
    }
    box.add("wheels", wheels, {0.12F, 0.12F, 0.13F}, place, 60);
    box.add("car", body, paintOf(number), place);
}

// Five cars on a round track; each hangs from the track's middle.
void addTrain(Toybox& box, GltfWriter& writer) {
    constexpr float kRadius = 4.6F;
    const int middle = box.addPlace("railway", {-6.8F, 0, 1.5F});
    Mesh rails, sleepers;
    for (const float side : {-0.5F, 0.5F}) {
        Mesh rail = makeTorus(kRadius + side, 0.06F, 128, 10);
        append(rails, rail, yaw(0), {0, 0.16F, 0});
    }
    for (int i = 0; i < 44; ++i) {
        const quat turn = yaw(360.0F * static_cast<float>(i) / 44);
        append(sleepers, makeBlock(vec3(0), {0.75F, 0.05F, 0.12F}, 0.02F), turn,
               turn * vec3(kRadius, 0, 0) + vec3(0, 0.05F, 0));
    }
    box.add("rails", rails, {0.35F, 0.35F, 0.38F}, middle, 60);
    box.add("sleepers", sleepers, kWood, middle);
    const int train = box.addPlace("train", {0, 0.13F, 0}, middle);
    for (int car = 0; car < 5; ++car) {
        const quat turn = yaw(50 + 27.5F * static_cast<float>(car));
        json node = placedNode("carPlace", turn * vec3(kRadius, 0, 0), turn * yaw(180));
        addCar(box, car, addUnder(writer, train, node));
    }
    box.rotate(train, [](float share) { return yaw(-360 * share); });
}

// A roof on a pole that turns boats around; each boat swings out.
void addCarousel(Toybox& box) {
    const int place = box.addPlace("carousel", {8.2F, 0, -3.6F});
    Mesh base;
    append(base, makeLathe({{3.2F, 0}, {3.2F, 0.25F}, {2.9F, 0.4F}, {0.4F, 0.5F}}, 72));
    append(base, makeLathe({{0.22F, 0.45F},
                            {0.16F, 1.2F},
                            {0.2F, 3.4F},
                            {0.12F, 7.0F},
                            {0.22F, 7.15F},
                            {0.05F, kCarouselHeight}},
                           40));
    box.add("carouselBase", base, kWood, place);
    const int top = box.addPlace("carouselTop", {0, 0, 0}, place);
    Mesh roof;
    append(roof,
           makeLathe({{0.2F, 5.7F}, {3.4F, 5.6F}, {3.5F, 5.7F}, {3.4F, 5.85F}, {0.24F, 6.9F}}, 72));
    box.add("roof", roof, kRed, top);
    for (int i = 0; i < 8; ++i) {
        const quat turn = yaw(45.0F * static_cast<float>(i));
        const int boat = box.addPlace("boatPlace", turn * vec3(2.9F, 5.65F, 0), top);
        Mesh hull;
        append(hull, makeBar({0, 0, 0}, {0, -3.1F, 0}, 0.045F, 14));
        std::vector<SweepRing> rings;
        for (int k = -8; k <= 8; ++k) {
            const float t = static_cast<float>(k) / 8;
            rings.push_back({{0, -3.2F + 0.25F * t * t, 0.95F * t},
                             0.36F * std::sqrt(1.06F - t * t),
                             0.26F * std::sqrt(1.06F - t * t)});
        }
        append(hull, makeSweep(rings, {0, 1, 0}, 28));
        append(hull, makeSphere(0.24F, 28, 18), yaw(0), {0, -2.75F, 0});
        for (vec3& position : hull.positions) position = turn * position;
        box.add("boat", hull, paintOf(i), boat, 60);
        const vec3 along = turn * vec3(0, 0, 1);
        box.rotate(boat, [along, i](float share) {
            const float swing =
                std::sin(glm::two_pi<float>() * (2 * share + 0.125F * static_cast<float>(i)));
            return glm::angleAxis(glm::radians(14 + 5 * swing), along);
        });
    }
    box.rotate(top, [](float share) { return yaw(360 * share); });
}

// Rings on a peg that rocks on its round foot.
void addRings(Toybox& box) {
    const int place = box.addPlace("rings", {-4.6F, 0, -7.2F});
    Mesh peg;
    append(peg, makeLathe({{0.3F, 0.0F},
                           {1.3F, 0.16F},
                           {1.75F, 0.5F},
                           {1.6F, 0.62F},
                           {0.3F, 0.7F},
                           {0.28F, 4.9F},
                           {0.12F, 5.05F}},
                          64));
    append(peg, makeSphere(0.42F, 40, 26), yaw(0), {0, 5.3F, 0});
    box.add("peg", peg, kWood, place);
    float y = 0.66F;
    for (int i = 0; i < 6; ++i) {
        const float tube = 0.42F - 0.03F * static_cast<float>(i);
        Mesh ring;
        append(ring, makeTorus(1.25F - 0.14F * static_cast<float>(i), tube, 56, 22), yaw(0),
               {0, y + tube, 0});
        y += 1.85F * tube;
        box.add("ring", ring, paintOf(i), place, 60);
    }
    box.rotate(place, [](float share) {
        return turn(9 * std::sin(2 * glm::two_pi<float>() * share), {0.3F, 0, 1});
    });
}

void addTop(Toybox& box) {
    const int tip = box.addPlace("topTip", {6.6F, 0.03F, 5.4F});
    const int spin = box.addPlace("topSpin", {0, 0, 0}, tip);
    box.add("top",
            makeLathe({{0.02F, 0},
                       {0.1F, 0.12F},
                       {0.75F, 0.8F},
                       {1.25F, 1.2F},
                       {1.3F, 1.4F},
                       {1.1F, 1.6F},
                       {0.4F, 1.85F},
                       {0.14F, 1.95F},
                       {0.11F, 2.7F},
                       {0.05F, 2.75F}},
                      64),
            kYellow, spin);
    Mesh pegs;
    for (int i = 0; i < 6; ++i)
        append(pegs, makeSphere(0.16F, 24, 16), yaw(0),
               yaw(60.0F * static_cast<float>(i)) * vec3(1.3F, 1.3F, 0));
    box.add("topPegs", pegs, kRed, spin, 60);
    box.rotate(tip, [](float share) {
        return yaw(720 * share) * turn(17, {0, 0, 1}) * yaw(-720 * share);
    });
    box.rotate(spin, [](float share) { return yaw(2880 * share); });
}

// Balls that bounce in place, a whole number of times a loop.
void addBalls(Toybox& box) {
    const struct {
        vec2 at;
        float radius, height;
        float bounces, phase;
    } balls[] = {{{-9.5F, 8.6F}, 0.95F, 3.2F, 4, 0.1F}, {{-6.4F, 10.2F}, 0.7F, 2.4F, 5, 0.6F},
                 {{0.2F, 10.8F}, 0.8F, 3.4F, 4, 0.35F}, {{4.0F, 10.4F}, 0.6F, 1.9F, 6, 0.8F},
                 {{11.4F, 2.2F}, 0.85F, 3.0F, 4, 0.5F}, {{-11.8F, -5.8F}, 1.0F, 2.6F, 4, 0.75F},
                 {{2.0F, 1.4F}, 0.7F, 2.8F, 5, 0.25F}};
    int number = 0;
    for (const auto& ball : balls) {
        const int place = box.addPlace("ballPlace", {ball.at.x, ball.radius, ball.at.y});
        box.add("ball", makeSphere(ball.radius, 44, 28), paintOf(++number), place, 60);
        box.move(place, [&](float share) {
            const float phase = share * ball.bounces + ball.phase;
            const float s = phase - std::floor(phase);
            return vec3(ball.at.x, ball.radius + ball.height * 4 * s * (1 - s), ball.at.y);
        });
    }
}

// Building blocks: a gate with a roof, a leaning pile, and some that lie about.
void addBlocks(Toybox& box) {
    const auto put = [&](const vec3& at, const vec3& half, float yawDeg, int paint) {
        Mesh mesh;
        append(mesh, makeBlock(vec3(0), half, 0.07F), yaw(yawDeg), at);
        box.add("block", mesh, paintOf(paint), -1);
    };
    for (const float x : {8.6F, 11.4F})
        for (int level = 0; level < 3; ++level)
            put({x, 0.7F + 1.4F * static_cast<float>(level), 8.4F}, vec3(0.7F),
                4 * static_cast<float>(level) - 3, level + (x > 9 ? 2 : 0));
    put({10, 4.55F, 8.4F}, {2.3F, 0.35F, 0.7F}, 0, 3);
    put({10, 5.35F, 8.4F}, {1.2F, 0.45F, 0.6F}, 6, 1);
    for (int level = 0; level < 4; ++level)
        put({-11.4F + 0.12F * static_cast<float>(level), 0.65F + 1.3F * static_cast<float>(level),
             -10},
            vec3(0.65F), 17 * static_cast<float>(level), level);
    put({4.4F, 0.5F, 8.2F}, vec3(0.5F), 31, 0);
    put({-3.4F, 0.55F, 11.6F}, vec3(0.55F), 12, 4);
    put({6.4F, 0.6F, 11.6F}, vec3(0.6F), 52, 2);
    put({-8.8F, 0.5F, 12.2F}, {0.9F, 0.5F, 0.5F}, -24, 3);
}

// A hoop that leans inward and rolls in a circle.
void addHoop(Toybox& box) {
    constexpr float kCircle = 2.2F, kRadius = 0.95F;
    const int middle = box.addPlace("hoopCircle", {3.1F, 0, 1.2F});
    const int place = box.addPlace("hoopPlace", {kCircle, kRadius, 0}, middle);
    Mesh hoop;
    append(hoop, makeTorus(kRadius - 0.1F, 0.1F, 72, 18),
           glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1)), vec3(0));
    box.add("hoop", hoop, kBlue, place, 60);
    box.rotate(middle, [](float share) { return yaw(360 * share); });
    box.rotate(place, [](float share) {
        return turn(16, {0, 0, 1}) * turn(-2 * 360 * share, {1, 0, 0});
    });
}

// What hangs on string `number`, below the origin.
Mesh makePendant(int number, float length) {
    Mesh mesh;
    append(mesh, makeBar({0, 0, 0}, {0, -length, 0}, 0.04F, 10));
    const vec3 middle(0, -length - 0.6F, 0);
    if (number % 3 == 0) {
        append(mesh, makeTorus(0.62F, 0.13F, 56, 16), kUpright, middle);
        append(mesh, makeTorus(0.3F, 0.09F, 36, 12), kUpright, middle);
        append(mesh, makeBar(middle + vec3(0, 0.6F, 0), middle + vec3(0, 0.3F, 0), 0.05F, 10));
    } else if (number % 3 == 1) {
        // A string of beads, the largest in the middle
        for (int bead = -2; bead <= 2; ++bead) {
            const auto place = static_cast<float>(bead);
            append(mesh, makeSphere(0.42F - 0.08F * std::abs(place), 26, 16), yaw(0),
                   middle + vec3(0, 0.62F * place, 0));
        }
    } else {
        // A flower
        append(mesh, makeSphere(0.3F, 26, 16), yaw(0), middle);
        for (int leaf = 0; leaf < 6; ++leaf)
            append(mesh, makeSphere(0.26F, 22, 14), yaw(0),
                   middle + turn(60.0F * static_cast<float>(leaf), {0, 0, 1}) * vec3(0.5F, 0, 0));
    }
    return mesh;
}

// A frame across the floor from which pendants swing: their shadows are the softest.
void addGym(Toybox& box) {
    constexpr float kBar = kGymHeight - 0.25F, kHalf = 12.6F;
    const vec3 middle(-1.6F, 0, -4.6F);
    const int place = box.addPlace("gym", middle);
    Mesh frame;
    addStrut(frame, {-kHalf, kBar, 0}, {kHalf, kBar, 0}, 0.22F, 28);
    for (const float side : {-1.0F, 1.0F})
        for (const float foot : {-3.6F, 3.6F})
            append(frame, makeBar({side * (kHalf - 0.3F), kBar, 0}, {side * kHalf, 0.14F, foot},
                                  0.18F, 24));
    box.add("frame", frame, kWood, place, 60);
    for (int i = 0; i < 9; ++i) {
        const float x = -10.4F + 2.6F * static_cast<float>(i);
        const int pendant = box.addPlace("pendantPlace", {x, kBar, 0}, place);
        box.add("pendant", makePendant(i, i % 2 == 0 ? 1.9F : 3.3F), paintOf(i), pendant, 60);
        box.rotate(pendant, [i](float share) {
            const float swing =
                std::sin(glm::two_pi<float>() * (2 * share + 0.13F * static_cast<float>(i)));
            return turn(11 * swing, {1, 0, 0.25F});
        });
    }
}

}  // namespace

void makeToys(GltfWriter& writer) {
    Exhibit exhibit(writer);
    addSoldiers(writer, exhibit);
    Toybox box(writer, exhibit, 0);  // the soldiers' animation
    addTrain(box, writer);
    addCarousel(box);
    addRings(box);
    addTop(box);
    addBalls(box);
    addBlocks(box);
    addHoop(box);
    addGym(box);
    const int bear = box.addPlace("bearPlace", {1.2F, 0, -5.6F});
    box.add("bearButtons", makeBearButtons(), {0.06F, 0.05F, 0.05F}, bear, 60);
    box.add("bear", makeBear(exhibit.trianglesLeft(kTriangleCount) / 2 * 2), {0.45F, 0.28F, 0.14F},
            bear, 60);
    exhibit.finish({.diagonal = 46,
                    .lightDistance = 43,
                    .towardsLight = {-0.5F, 0.68F, -0.42F},
                    .eye = {3, 29, 19},
                    .target = {0.2F, 0, 0.6F},
                    .yfovDeg = 42,
                    .groundColour = {0.6F, 0.55F, 0.47F}});
}

}  // namespace tools
