"""Where the tool mount is: the project's forward kinematics against Pinocchio's of a URDF.

Usage: kinematics.py OURS
OURS is the program built from crates/sim/examples/forward.rs. Exits with 1 beyond the tolerance.
"""

import json
import pathlib
import subprocess
import sys

import numpy as np
import pinocchio

SEED = 20250101
CONFIGURATIONS = 1000
# Of any element of the rotation, and of any coordinate in metres.
TOLERANCE = 1e-9


def frame_in(data, model, frame, reference):
    """The pose of a frame in another one."""
    def placed(name):
        return data.oMf[model.getFrameId(name)]

    return placed(reference).actInv(placed(frame))


def main():
    urdf = pathlib.Path(__file__).parent / "ur5.urdf"
    model = pinocchio.buildModelFromUrdf(str(urdf))
    data = model.createData()
    random = np.random.default_rng(SEED)
    joints = random.uniform(-2 * np.pi, 2 * np.pi, (CONFIGURATIONS, model.nq))
    text = "\n".join(json.dumps(list(row)) for row in joints) + "\n"
    done = subprocess.run([sys.argv[1]], input=text, capture_output=True, text=True, check=True)
    worst = {"base": 0.0, "base_link": 0.0}
    for row, line in zip(joints, done.stdout.splitlines(), strict=True):
        ours = json.loads(line)
        pinocchio.framesForwardKinematics(model, data, row)
        for reference in worst:
            pose = frame_in(data, model, "tool0", reference)
            turned = np.abs(pose.rotation - np.array(ours["rotation"])).max()
            moved = np.abs(pose.translation - np.array(ours["position_m"])).max()
            worst[reference] = max(worst[reference], turned, moved)
    print(f"{CONFIGURATIONS} random configurations, seed {SEED}, "
          f"Pinocchio {pinocchio.__version__}\n")
    print("| frame of the URDF | greatest difference |")
    print("| --- | ---: |")
    for reference, difference in worst.items():
        print(f"| `{reference}` | {difference:.1e} |")
    # The convention is pinned from both sides: ours is the maker's frame, and not the URDF's.
    is_base = worst["base"] <= TOLERANCE
    is_turned = worst["base_link"] > 1.0
    sys.exit(0 if is_base and is_turned else 1)


if __name__ == "__main__":
    main()
