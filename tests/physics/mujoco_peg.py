"""A peg pushed into a hole in MuJoCo: the model, its settings with their reasons, and one trial.

Knows nothing of this project's own contact. Trials are dictionaries in mm, N and rad, as
`crates/sim/examples/insertions.rs` reads them; inside, everything is in metres.
"""

import dataclasses

import mujoco
import numpy as np

MM = 1e-3


@dataclasses.dataclass(frozen=True)
class Settings:
    """What is chosen for the solver. At MuJoCo's defaults no peg goes into a tight hole."""

    # Contacts are springs of the time constant below, and that must be two steps at least.
    timestep_s: float = 5e-4
    # With the mass below about 2e6 N/m: 20 N press by 0.01 mm, less than any clearance here.
    contact_time_s: float = 1e-3
    # Stiff from the first touch on (the default begins at 0.9 and is full at 1 mm).
    impedance: str = "0.95 0.99 0.00005"
    # The true cone. A pyramid lets friction grow by up to 1.4 with the direction.
    cone: str = "elliptic"
    # Friction is stiffer than the normal force by this: less creep of a peg that sticks.
    impratio: float = 10.0
    # Stiff springs of the hand are integrated implicitly.
    integrator: str = "implicitfast"
    solver: str = "Newton"
    iterations: int = 50
    tolerance: float = 1e-10
    # Of the peg. Nothing has weight; so it says how fast springs swing, and is chosen for the
    # stiffness of the contact, above, and for a hand that swings within 0.1 s.
    mass_kg: float = 2.0
    gyration_m: float = 0.02
    # The share of critical damping of the hand's springs. More of it would be felt as force where
    # the chamfer moves the peg aside at once.
    damping: float = 0.3
    # The hand goes on slowly, so that forces are those of rest: more slowly over the chamfers,
    # where the peg goes aside as fast as it goes down.
    chamfer_speed_m_per_s: float = 0.005
    bore_speed_m_per_s: float = 0.03
    # Around the hole. Between two sectors the wall is too far by R (1 - cos(pi / 64)) = 0.012 mm;
    # the directions of the trials are the middles of sectors.
    sectors: int = 64
    # The rim of the peg and the throat of the hole are round, by spheres: where a sharp edge goes
    # over the seam of two boxes, that it presses into by a little, it is caught by the end of the
    # second one. On a slope of 45 degrees a rim of this radius is a chamfer of 0.586 times that.
    rounding_mm: float = 0.05


SETTINGS = Settings()

# A rounding r touches a slope of 45 degrees as a chamfer of 45 degrees, (2 - sqrt 2) r wide, does.
ROUNDING_AS_CHAMFER = 2.0 - np.sqrt(2.0)


def wall(trial, settings):
    """The hole, z up: sectors of bore, chamfer and face, and spheres along the throat."""
    radius = (trial["peg_radius_mm"] + trial["clearance_mm"]) * MM
    chamfer = trial["hole_chamfer_mm"] * MM
    depth = (trial["depth_mm"] + 10.0) * MM
    rounding = settings.rounding_mm * MM
    thick, face = 4.0 * MM, 20.0 * MM
    half = np.pi / settings.sectors
    # The middle of a chamfer's box: from the middle of its surface into the material.
    cone = np.array([radius + chamfer / 2, -chamfer / 2]) + np.array([1, -1]) / np.sqrt(2) * thick
    throat = (radius + rounding, -(chamfer + rounding * np.tan(np.pi / 8)))
    geoms = []

    def box(name, angle, middle, size, lean=0.0):
        x, y = middle[0] * np.cos(angle), middle[0] * np.sin(angle)
        geoms.append(
            f'<geom name="{name}" type="box" size="{size[0]} {size[1]} {size[2]}"'
            f' pos="{x} {y} {middle[1]}" euler="0 {lean} {angle}"/>'
        )

    for sector in range(settings.sectors):
        angle = 2 * np.pi * sector / settings.sectors
        long = (depth - chamfer) / 2
        box(f"bore{sector}", angle, (radius + thick, -chamfer - long),
            (thick, (radius + thick) * np.tan(half), long))
        box(f"cone{sector}", angle, cone,
            (thick, (radius + chamfer + 2 * thick) * np.tan(half), chamfer / np.sqrt(2)),
            lean=np.pi / 4)
        box(f"face{sector}", angle, (radius + chamfer + face / 2, -thick),
            (face / 2, (radius + chamfer + face) * np.tan(half), thick))
        x, y = throat[0] * np.cos(angle), throat[0] * np.sin(angle)
        geoms.append(
            f'<geom name="throat{sector}" type="sphere" size="{rounding}"'
            f' pos="{x} {y} {throat[1]}"/>'
        )
    return "".join(geoms)


def rim(trial, settings):
    """The round rim of the peg, whose end is at the origin."""
    rounding = settings.rounding_mm * MM
    ring = trial["peg_radius_mm"] * MM - rounding
    geoms = []
    for sector in range(settings.sectors):
        angle = 2 * np.pi * sector / settings.sectors
        geoms.append(
            f'<geom name="rim{sector}" type="sphere" size="{rounding}"'
            f' pos="{ring * np.cos(angle)} {ring * np.sin(angle)} {rounding}"/>'
        )
    return "".join(geoms)


def pairs(trial, settings):
    """What may touch: the rim the walls near it, and the side of the peg the throat."""
    friction = trial["friction"]
    more = (
        f'condim="3" friction="{friction} {friction} 0 0 0"'
        f' solref="{settings.contact_time_s} 1" solimp="{settings.impedance}"'
    )
    found = []
    for sector in range(settings.sectors):
        for near in (sector - 1, sector, sector + 1):
            for kind in ("bore", "cone", "face"):
                other = f"{kind}{near % settings.sectors}"
                found.append(f'<pair geom1="rim{sector}" geom2="{other}" {more}/>')
        found.append(f'<pair geom1="side" geom2="throat{sector}" {more}/>')
    return "".join(found)


def model(trial, settings=SETTINGS):
    """The hole stands; a hand, driven along the axis of the peg, holds it by springs: along and
    across its axis, and in tilt about the middle of its rim."""
    rounding = settings.rounding_mm * MM
    length = (trial["depth_mm"] + 30.0) * MM
    mass, inertia = settings.mass_kg, settings.mass_kg * settings.gyration_m**2

    def joint(name, kind, axis, stiffness, moved, at=0.0):
        damping = 2.0 * settings.damping * np.sqrt(stiffness * moved)
        return (
            f'<joint name="{name}" type="{kind}" axis="{axis}" pos="0 0 {at}"'
            f' stiffness="{stiffness}" damping="{damping}"/>'
        )

    across, along = trial["lateral_n_per_mm"] / MM, trial["axial_n_per_mm"] / MM
    tilt = trial["angular_nmm_per_rad"] * MM
    hand = "".join((
        joint("x", "slide", "1 0 0", across, mass),
        joint("y", "slide", "0 1 0", across, mass),
        joint("z", "slide", "0 0 1", along, mass),
        joint("a", "hinge", "1 0 0", tilt, inertia, rounding),
        joint("b", "hinge", "0 1 0", tilt, inertia, rounding),
    ))
    x, y = (offset * MM for offset in trial["offset_mm"])
    radius = trial["peg_radius_mm"] * MM
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian" eulerseq="XYZ"/>
  <option timestep="{settings.timestep_s}" gravity="0 0 0" cone="{settings.cone}"
    impratio="{settings.impratio}" integrator="{settings.integrator}" solver="{settings.solver}"
    iterations="{settings.iterations}" tolerance="{settings.tolerance}"/>
  <default><geom contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="hole">{wall(trial, settings)}</body>
    <body name="hand" pos="{x} {y} 0" euler="0 {-trial['tilt_rad']} 0">
      <inertial pos="0 0 0" mass="1e6" diaginertia="1 1 1"/>
      <joint name="drive" type="slide" axis="0 0 -1"/>
      <body name="peg">
        <inertial pos="0 0 {rounding}" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>
        {hand}
        <geom name="side" type="cylinder" size="{radius} {length / 2}"
          pos="0 0 {length / 2 + rounding}"/>
        {rim(trial, settings)}
      </body>
    </body>
  </worldbody>
  <contact>{pairs(trial, settings)}</contact>
</mujoco>""")


def insert(trial, settings=SETTINGS):
    """Push until the force along the axis exceeds the limit or the hand has come to the depth;
    whether it has, how deep it came, and the greatest force."""
    built = model(trial, settings)
    data = mujoco.MjData(built)
    drive = built.joint("drive").qposadr[0]
    along = built.joint("z").qposadr[0]
    driven = built.joint("drive").dofadr[0]
    stiffness = trial["axial_n_per_mm"] / MM
    depth, chamfers = trial["depth_mm"] * MM, 3.0 * trial["hole_chamfer_mm"] * MM
    # Begin with the lowest point of the rim above the face.
    way = -0.2 * MM - trial["peg_radius_mm"] * MM * abs(np.sin(trial["tilt_rad"]))
    most_n = 0.0
    while way < depth:
        speed = settings.chamfer_speed_m_per_s if way < chamfers else settings.bore_speed_m_per_s
        # The hand goes as it is driven, whatever meets the peg.
        data.qpos[drive], data.qvel[driven] = way, speed
        way += speed * settings.timestep_s
        mujoco.mj_step(built, data)
        force_n = data.qpos[along] * stiffness
        most_n = max(most_n, force_n)
        if force_n > trial["force_limit_n"]:
            break
    return {"inserted": bool(way >= depth), "depth_mm": way / MM, "force_n": float(most_n)}
