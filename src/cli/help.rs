//! Examples behind the help texts.

/// Behind `outsight --help`.
pub const OUTSIGHT: &str = "\
Start with:
  outsight demo                         the whole story in 20 seconds, in ./outsight-demo/
  outsight simplify part.ply -o small.ply -r 0.05
  outsight compare part.ply small.ply -o differences.png

Exit codes: 0 done, 1 the answer is no, 2 wrong use, 3 bad input, 4 output not written,
5 limit reached, 6 not available here, 70 a bug in Outsight, 130 and 143 interrupted.";

/// Behind `outsight demo --help`.
pub const DEMO: &str = "\
Measures the bundled gearbox, simplifies it to 5 % without and with visibility, compares both
with the original, and writes meshes, pictures, report.html and demo.json. Replaces its files of
earlier runs.

Example:
  outsight demo";

/// Behind `outsight info --help`.
pub const INFO: &str = "\
Examples:
  outsight info bunny.ply
  outsight info --json scan.stl.gz | jq .topology.closed
  curl -s https://example.org/part.obj | outsight info -";

/// Behind `outsight measure --help`.
pub const MEASURE: &str = "\
Examples:
  outsight measure part.ply                   visibility of the mesh, in a few lines
  outsight measure part.ply -o heat.ply       triangles coloured, with the property visibility
  outsight measure part.ply -o v.npy --json   one number per triangle for NumPy, and a summary
  outsight measure part.ply --report part.html   one page: plots, pictures, the model to turn
  outsight measure part.ply --preset paper    as Zhang & Turk 2002 did
  outsight measure part.ply --hemisphere +z   never seen from below
  outsight measure part.ply --occluder floor.ply --occluder wall.ply
  outsight measure part.ply --diagram d.npy   which camera sees which triangle";

/// Behind `outsight explain --help`.
pub const EXPLAIN: &str = "\
TRIANGLE counts the file's triangles from 0, as the rows of measure's .csv and .npy do. Rays go from
four points of the triangle to each camera in front of it, whatever backend measured it.

Examples:
  outsight explain part.ply 1234              who sees it, and which triangles are in the way
  outsight explain part.ply 1234 --back --all all cameras, from the other side
  outsight explain part.ply 1234 --json | jq '.blockers[0]'";

/// Behind `outsight verify --help`.
pub const VERIFY: &str = "\
A backend alone counts coverage; an estimator alone runs on its usual backend. Ends with code 1 if a
pair does not keep its limits; pairs that measure different things have none.

Examples:
  outsight verify part.ply                                   raster against embree and hemisphere
  outsight verify part.ply --backends raster,embree -o differences
  outsight verify part.ply --backends embree,surface@embree,item-buffer --json | jq .pairs";

/// What clap would write over two lines.
pub const SIMPLIFY_USAGE: &str =
    "outsight simplify [OPTIONS] <MESH> -o <FILE> <-t <N>|-r <RATIO>|-e <ERROR>|--lods <LIST>>";

/// Behind `outsight simplify --help`.
pub const SIMPLIFY: &str = "\
Of several sizes and errors the first one reached stops. With --lods, level N is written to FILE
with -lodN before its ending, or to FILE with N in place of {}. Triangles that no camera sees are
deleted, and counted in a warning; --hidden keep keeps them.

Examples:
  outsight simplify part.ply -o small.ply -r 0.05            keep 5 % of the triangles
  outsight simplify part.obj -o small.stl -t 20000 -e 0.1    20,000 triangles, or error 0.1
  outsight simplify part.ply -o part-{}.ply --lods 0.5,0.25,0.1
  outsight simplify part.ply -o qb.ply -r 0.05 --metric quadric
  outsight simplify part.ply -o small.glb -r 0.05 --report small.html
  outsight simplify - -o - --output-format ply -r 0.1 < in.stl > out.ply";

/// Behind `outsight compare --help`.
pub const COMPARE: &str = "\
REF is looked at too, to tell error that shows from error that is hidden.

Examples:
  outsight compare part.ply small.ply
  outsight compare part.ply qb.ply vg.ply -o differences.png --report differences.html
  outsight compare part.ply small.ply --cache looks          reuse what simplify saw
  outsight compare part.ply small.ply --json | jq '.tests[0].image_rmse'";

/// Behind `outsight render --help`.
pub const RENDER: &str = "\
Examples:
  outsight render part.ply -o part.png --camera 1,1,0.5
  outsight render part.ply -o heat.png --style heat --colour-map cividis";

/// Behind `outsight convert --help`.
pub const CONVERT: &str = "\
Examples:
  outsight convert scan.stl scan.ply.zst
  outsight convert part.obj part.off --weld
  outsight convert - out.ply --input-format stl < in.stl";

/// Behind `outsight study convergence --help`.
pub const STUDY_ZT: &str = "\
Looks at every model with the paper's options and with the best ones, simplifies it by quadric error
alone (QB) and guided by visibility (VG) to seven levels and to the counts that the paper names, and
says how far each result is from the original, in pictures and in space. Beside each number stands
what the paper prints, where it prints any.

The directory gets report.html to read, zt.json and tables as .csv, plots as .svg, pictures as .png.
What was found is kept there under cells/: a run that was stopped goes on with the next cell.

Names of the paper's models: bunny, teapot, dragon, buddha, locking_tori, foot_bone, blade, skull,
motor, locomotive. A file named so needs no NAME=.

Examples:
  outsight study zt bunny.ply motor=engine.ply -o zt/ --dry-run
  outsight study zt bunny.ply motor=engine.ply skull=head-ct.ply -o zt/";

pub const STUDY_CONVERGENCE: &str = "\
Compares visibility from 6 to 4098 octahedral cameras, counted alike and by the solid angle they
own, with the most of them, and with a reference that is found without these cameras: rays all over
each triangle, or cameras of another pattern. Only that reference shows the error that equal weights
keep however many cameras there are.

Pixels bring an error of their own, largest on fine meshes: raise --resolution, and what falls was theirs.

Examples:
  outsight study convergence part.ply bunny.ply -o convergence/
  outsight study convergence part.ply -o convergence/ --against fibonacci";

/// Behind `outsight doctor --help`.
pub const DOCTOR: &str = "\
Ends with code 1 if the self-check fails.

Example:
  outsight doctor --json | jq .backends";

/// Behind `outsight completions --help`.
pub const COMPLETIONS: &str = "\
Examples:
  outsight completions bash > ~/.local/share/bash-completion/completions/outsight
  outsight completions zsh > ~/.zfunc/_outsight";

/// Behind `outsight man --help`.
pub const MAN: &str = "\
Examples:
  outsight man | man -l -
  outsight man --dir ~/.local/share/man/man1";
