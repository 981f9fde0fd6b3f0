// Steps a scene with Box2D Lite and says how long that took. `tumble bench --box2d-lite DIR` compiles it against the
// checkout in DIR and talks with it through standard input and output:
//
//   world DT GRAVITY_X GRAVITY_Y ITERATIONS ACCUMULATE_IMPULSES WARM_STARTING POSITION_CORRECTION
//   bodies N     then N times: WIDTH HEIGHT MASS X Y ANGLE VELOCITY_X VELOCITY_Y ANGULAR_VELOCITY FRICTION
//   joints N     then N times: BODY1 BODY2 ANCHOR_X ANCHOR_Y SOFTNESS BIAS_FACTOR
//   step N       makes N steps; answers N lines: CPU and wall time of each [ms]
//   positions    answers a line for each body: X Y [m]
//
// Units are SI; a mass of 0 stands for a body that never moves. It ends with its input.

#include "box2d-lite/Body.h"
#include "box2d-lite/Joint.h"
#include "box2d-lite/World.h"

#include <cfloat>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <string>
#include <vector>

struct Scene
{
	World world = World(Vec2(0.0f, 0.0f), 10);
	float dt = 1.0f / 60.0f;
	// Contiguous, as in the engine's own demos: it orders its contacts by the bodies' addresses.
	std::vector<Body> bodies;
	std::vector<Joint> joints;
};

static double now(clockid_t clock)
{
	timespec t;
	clock_gettime(clock, &t);
	return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void readWorld(Scene& scene)
{
	std::cin >> scene.dt >> scene.world.gravity.x >> scene.world.gravity.y >> scene.world.iterations;
	std::cin >> World::accumulateImpulses >> World::warmStarting >> World::positionCorrection;
}

static void readBodies(Scene& scene)
{
	size_t count = 0;
	std::cin >> count;
	scene.bodies.resize(count);
	for (Body& body : scene.bodies)
	{
		Vec2 width;
		float mass = 0.0f;
		std::cin >> width.x >> width.y >> mass;
		body.Set(width, mass > 0.0f ? mass : FLT_MAX);
		std::cin >> body.position.x >> body.position.y >> body.rotation;
		std::cin >> body.velocity.x >> body.velocity.y >> body.angularVelocity >> body.friction;
		scene.world.Add(&body);
	}
}

static void readJoints(Scene& scene)
{
	size_t count = 0;
	std::cin >> count;
	scene.joints.resize(count);
	for (Joint& joint : scene.joints)
	{
		size_t body1 = 0, body2 = 0;
		Vec2 anchor;
		std::cin >> body1 >> body2 >> anchor.x >> anchor.y;
		joint.Set(&scene.bodies.at(body1), &scene.bodies.at(body2), anchor);
		std::cin >> joint.softness >> joint.biasFactor;
		scene.world.Add(&joint);
	}
}

static void step(Scene& scene)
{
	int count = 0;
	std::cin >> count;
	std::vector<double> cpu(count), wall(count);
	for (int i = 0; i < count; ++i)
	{
		double wallBefore = now(CLOCK_MONOTONIC);
		double cpuBefore = now(CLOCK_PROCESS_CPUTIME_ID);
		scene.world.Step(scene.dt);
		cpu[i] = now(CLOCK_PROCESS_CPUTIME_ID) - cpuBefore;
		wall[i] = now(CLOCK_MONOTONIC) - wallBefore;
	}
	for (int i = 0; i < count; ++i)
		std::printf("%.6f %.6f\n", cpu[i], wall[i]);
}

static void writePositions(const Scene& scene)
{
	for (const Body& body : scene.bodies)
		std::printf("%.9g %.9g\n", body.position.x, body.position.y);
}

int main()
{
	Scene scene;
	std::string word;
	while (std::cin >> word)
	{
		if (word == "world") readWorld(scene);
		else if (word == "bodies") readBodies(scene);
		else if (word == "joints") readJoints(scene);
		else if (word == "step") step(scene);
		else if (word == "positions") writePositions(scene);
		else return 1;
		if (!std::cin) return 1;
		std::fflush(stdout);
	}
	return 0;
}
