// The commands: what each does, its examples, its options.
#include "cli/command_options.hpp"

namespace carom::cli {

void define_commands(CLI::App& app, Options& o, const std::string* only) {
  constexpr const char *compute = "Compute", *look = "Look", *data = "Data and checks";
  Command(app, o, only, compute, "escape", "Measure survival and escape rate of an ensemble",
          "Examples:\n"
          "  carom escape magnetic-square\n"
          "  carom escape mushroom --trajectories 1e6 --times log:1:1000:31 --json\n"
          "  carom escape stadium --trajectories 1e5 --per-trajectory -o basins.h5\n"
          "\n"
          "With -o a checkpoint is written every ten seconds: carom escape --resume FILE.h5 "
          "continues after Ctrl-C, a kill or a full disk, with the same bits.\n"
          "A closed table is allowed: nothing escapes. Exit status 3 if a trajectory could not be "
          "followed.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep()
      .motion()
      .ensemble()
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)")
      .flag("--per-trajectory", o.per_trajectory,
            "Store start, fate, hole, time and hits of each trajectory in the archive")
      .text("--window", o.window, "FROM:TO", "Times between which the decay is fitted")
      .parts()
      .text("--splitting", o.splitting, "LEVELS",
            "Rare events: times, or hits:lin:0:50:51, at which survivors are copied")
      .text("--population", o.population, "N",
            "With --splitting: trajectories of a population (default 20000)")
      .text("--repetitions", o.repetitions, "N",
            "With --splitting: populations for each kick (default 16)")
      .text("--kick", o.kick, "DELTA",
            "With --splitting: the largest kick (default: chosen by a first population)")
      .for_tests("--lookback", o.lookback);
  Command(app, o, only, compute, "run", "Follow one trajectory and store every hit",
          "Examples:\n"
          "  carom run mushroom --trajectory 7 --t-max 100\n"
          "  carom run circle --closed --position 1/10,0 --velocity 1,2 -o orbit.h5\n"
          "  carom run --resume orbit.h5 --collisions 2e4     continues it\n"
          "\n"
          "With --collisions but without --t-max the run has no last time.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep()
      .motion()
      .verbose()
      .output("FILE",
              "Write an archive (.h5): every hit, and samples if run.sample is set; or draw a "
              "picture (.png, .svg, .pdf)")
      .text("--trajectory", o.trajectory, "I", "Which trajectory of the ensemble (default 0)")
      .text("--trust-tolerance", o.overrides.trust_tolerance, "X",
            "Largest error of a trusted collision, in units of the table's size (default 1e-3)")
      .text("--precision", o.precision, "double|certified", "Certified: every digit guaranteed")
      .text("--digits", o.digits, "D", "Guaranteed decimals of a certified run (default 20)")
      .text("--resume", o.resume, "FILE.h5", "Continue a stored run instead of SYSTEM");
  Command(app, o, only, compute, "diffusion", "Measure the diffusion coefficient of an ensemble",
          "Examples:\n"
          "  carom diffusion lorentz-triangular\n"
          "  carom diffusion lorentz-triangular --set field.B=0.5 --window 20:200 --json\n"
          "  carom diffusion soft-lorentz --t-max 100 -o msd.h5\n"
          "  carom diffusion lorentz-square --free-paths\n"
          "\n"
          "D is a quarter of the slope of the MSD in a window of report times (default: the last "
          "decade).\n"
          "Checkpoints, --resume, --shard and mpirun as with carom escape.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep()
      .motion()
      .ensemble()
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)")
      .parts()
      .text("--window", o.window, "FROM:TO",
            "Range of report times from which D and the exponent are computed")
      .free_paths();
  Command(
      app, o, only, compute, "lyapunov", "Measure Lyapunov exponents and the chaotic share",
      "Examples:\n"
      "  carom lyapunov stadium --closed --trajectories 1e4\n"
      "  carom lyapunov mushroom --closed --t-max 1e4 --json\n"
      "  carom lyapunov sinai --trajectories 1e4 --window 20:100 -o lambda.h5\n"
      "  carom lyapunov mushroom --closed --per-trajectory -o map.h5\n"
      "  carom lyapunov wigner --spectrum --trajectories 10\n"
      "\n"
      "Two deviations of each orbit are followed by the exact tangent maps of flights and hits.\n"
      "Checkpoints, --resume, --shard and mpirun as with carom escape.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep()
      .motion()
      .ensemble(false)
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)")
      .flag("--per-trajectory", o.per_trajectory,
            "Store start, fate, time, hits, exponent and SALI of each trajectory in the archive")
      .parts()
      .text("--window", o.window, "FROM:TO",
            "Times between which the growth is measured (default: the last four fifths of the run)")
      .spectrum();
  Command(app, o, only, compute, "returns", "Measure return times to a wall",
          "Examples:\n"
          "  carom returns stadium --closed --on wall:bottom --t-max 1000\n"
          "  carom returns mushroom --closed --on wall:stem_bottom -o returns.h5\n"
          "\n"
          "Only excursions that begin in the first half of the run are counted, so that each is "
          "followed for at least half of it.\n"
          "Checkpoints, --resume, --shard and mpirun as with carom escape.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep()
      .motion()
      .ensemble(false)
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)")
      .text("--on", o.on, "wall:NAME", "The wall (carom table lists them)")
      .parts();
  Command(app, o, only, compute, "section", "Follow many orbits to where they cross a surface",
          "Examples:\n"
          "  carom section ellipse-magnetic --orbits 20 --points 2000 -o section.h5\n"
          "  carom section stadium --closed --on line:0,-1:0,1 --direction positive\n"
          "  carom section henon-heiles --on x=0 --direction positive --points 500 --json\n"
          "\n"
          "WHERE is boundary, wall:NAME, line:x0,y0:x1,y1, segment:x0,y0:x1,y1, circle:x,y,r, "
          "x=c, y=c, vx=c or vy=c. With --points but without --t-max a boundary section has no "
          "last time.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep_that_goes_on()
      .motion()
      .threads()
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)")
      .text("--on", o.on, "WHERE", "Surface of the section (default: boundary)")
      .text("--direction", o.direction, "both|positive|negative", "Crossings that count")
      .text("--points", o.points, "N", "Largest number of points of an orbit (default 1000)")
      .text("--orbits", o.orbits, "N",
            "Number of orbits (default: the listed starts, else at most 50)");
  Command(app, o, only, compute, "relax", "Find equilibria and the oscillations about them",
          "Examples:\n"
          "  carom relax wigner\n"
          "  carom relax soft-lorentz --saddles -o equilibria.png\n"
          "\n"
          "Starts are those of the system's trajectories. Symmetric copies count once.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep_that_goes_on()
      .text("--seed", o.overrides.seed, "N", "Seed of the random numbers")
      .text("--starts", o.starts, "N", "Number of starts (default 200)")
      .flag("--saddles", o.saddles, "Search for saddles too")
      .threads()
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)");
  Command(app, o, only, compute, "compare", "Compare integrators: error against work",
          "Examples:\n"
          "  carom compare henon-heiles\n"
          "  carom compare soft-lorentz --schemes velocity-verlet,ruth-3 --error 1e-4\n"
          "  carom compare wigner --steps 0.1,0.05,0.025 --verbose -o compared.h5\n"
          "  carom compare stadium --closed --json      with exact flights\n"
          "\n"
          "Without --t-max the comparison ends before small errors have grown 100 times.\n"
          "carom schemes lists the schemes.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep_that_goes_on()
      .text("--seed", o.overrides.seed, "N", "Seed of the random numbers")
      .text("--t-max", o.comparison_time, "T", "Time of the comparison (default: chosen)")
      .text("--position", o.overrides.position, "X,Y", "Start, in exact numbers: 1/10,-1/5")
      .text("--velocity", o.overrides.velocity, "U,V",
            "Velocity of the start; only its direction counts if a speed is set")
      .text("--trajectory", o.trajectory, "I", "Trajectory whose start is used (default 0)")
      .text("--schemes", o.schemes, "A,B|all", "Schemes (default: a dozen, arkode and cvode)")
      .text("--steps", o.steps, "STEPS",
            "Steps, a,b,c or log:from:to:count (default: ten, halved from one to the next)")
      .text("--tolerances", o.tolerances, "TOLERANCES",
            "Tolerances of arkode and cvode, in the same form (default: 1e-3 to 1e-13)")
      .text("--error", o.error, "X", "Wanted error of the state (default 1e-6)")
      .verbose()
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)");
  Command(
      app, o, only, compute, "orbit", "Find periodic orbits and their stability",
      "Examples:\n"
      "  carom orbit three-disc --hits 8\n"
      "  carom orbit three-disc --hits 11 --zeta\n"
      "  carom orbit stadium --json\n"
      "  carom orbit magnetic-square --hits 4 --tries 1e4\n"
      "\n"
      "Each orbit is listed once, without other starts, its reversal and symmetric copies. Holes "
      "are treated as walls.\n"
      "Between discs in the open plane every sequence of discs is tried. Elsewhere the search "
      "starts from random orbits that nearly close, and may miss some.")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .sweep_that_goes_on()
      .text("--seed", o.overrides.seed, "N", "Seed of the random numbers")
      .threads()
      .verbose()
      .text("--hits", o.hits, "N", "Largest number of hits of an orbit (default 6)")
      .text("--starts", o.starts, "N",
            "Random orbits in which recurrences are sought (default 20000)")
      .text("--tries", o.tries, "N",
            "Recurrences that are tried for each number of hits (default 2000)")
      .flag("--zeta", o.zeta,
            "The escape rate of discs in the open plane, by cycle expansion of their orbits")
      .flag("--certify", o.certify, "Prove that each orbit exists, and give its digits")
      .text("--digits", o.digits, "D", "With --certify: guaranteed decimals (default 20)")
      .output("FILE", "Write an archive (.h5), or draw a picture (.png, .svg, .pdf)");
  Command(app, o, only, look, "table", "Check, measure and draw a table",
          "Examples:\n"
          "  carom table stadium\n"
          "  carom table mushroom --set table.stem_width=0.6 -o mushroom.svg\n"
          "  carom table three-disc --json")
      .system("SYSTEM", "Built-in name or TOML file")
      .settings()
      .verbose()
      .output("FILE.svg", "Draw the table");
  Command(app, o, only, look, "plot", "Draw an archive or a system",
          "Examples:\n"
          "  carom plot orbit.h5 -o orbit.pdf\n"
          "  carom plot mushroom -o mushroom.png\n"
          "  carom plot result.h5 --what rate\n"
          "  carom run stadium --collisions 100 -o orbit.png     computes and draws\n"
          "\n"
          "Without -o the picture is NAME.png in this folder, with --what NAME-WHAT.png. It needs "
          "Python with matplotlib.")
      .system("SOURCE", "Archive, TOML file or built-in name")
      .text("--what", o.what,
            "orbit|energy|survival|rate|basins|times|diffusion|correlation|free_paths|lyapunov|"
            "convergence|spectrum|exponents",
            "Which picture of a result (default: the first that it has)")
      .output("PICTURE", "A name ending in .png, .svg or .pdf");
  Command(
      app, o, only, look, "animate", "Make a film of a run or a system",
      "Examples:\n"
      "  carom animate lorentz-triangular -o lorentz.gif\n"
      "  carom animate wigner -o wigner.mp4\n"
      "  carom animate orbit.h5 -o orbit.gif     an archive of carom run\n"
      "  carom animate stadium --frames 400 --trail 400\n"
      "\n"
      "Without -o the film is NAME.gif in this folder. A run is shown until its hundredth hit, a "
      "system for twenty mean flights.\n"
      "It needs Python with matplotlib; .mp4 also needs ffmpeg.")
      .system("SOURCE", "Archive of carom run, TOML file or built-in name")
      .text("--frames", o.frames, "N", "Number of frames (default 100)")
      .text("--fps", o.fps, "N", "Frames a second (default 20)")
      .text("--trail", o.trail, "N", "Frames for which a way stays visible (default 10)")
      .output("FILM", "A name ending in .gif or .mp4");
  Command(app, o, only, look, "page", "Open the page that computes in a browser",
          "Examples:\n"
          "  carom page\n"
          "  carom page mushroom --set field.B=0.3     with that system\n"
          "\n"
          "The page shows the same numbers as carom, to the last bit. Its address is printed; on a "
          "terminal the page is opened.")
      .system("SYSTEM", "Built-in name or TOML file to begin with")
      .settings();
  Command(app, o, only, data, "merge", "Add the parts of an ensemble",
          "Examples:\n"
          "  carom escape stadium --shard 1/2 -o a.h5\n"
          "  carom escape stadium --shard 2/2 -o b.h5\n"
          "  carom merge all.h5 a.h5 b.h5     the archive of the whole ensemble\n"
          "\n"
          "Parts that overlap or belong to different ensembles are refused.")
      .files("FILES", "The archive to be written (or -o FILE.h5), then the parts")
      .output("FILE.h5", "The archive to be written")
      .verbose();
  Command(app, o, only, data, "systems", "List the built-in systems, or print one",
          "Examples:\n"
          "  carom systems\n"
          "  carom systems mushroom > my-mushroom.toml\n"
          "  carom systems --json")
      .system("NAME", "Built-in system to print");
  Command(app, o, only, data, "schemes", "List the integrators",
          "Examples:\n"
          "  carom schemes\n"
          "  carom schemes --json\n"
          "\n"
          "[integrator] scheme, or --set integrator.scheme=NAME, chooses one of them.");
  Command(app, o, only, data, "validate", "Check the engine against published values",
          "Examples:\n"
          "  carom validate                  closed tables, published values\n"
          "  carom validate --scale 0.01     a quick look\n"
          "  carom validate --soak --json    the long runs\n"
          "\n"
          "Exit status 3 if a case fails.")
      .flag("--soak", o.soak, "Long runs: 10^9 hits in each closed table, 10^7 for a mean flight")
      .text("--scale", o.scale, "X", "Factor for the trajectories of each case (default 1)")
      .threads()
      .verbose();
}

}  // namespace carom::cli
