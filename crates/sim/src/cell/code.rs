//! The codes of what is wrong with a workcell file, or with a program in it: a row a code, with the
//! page that explains it.
//!
//! A code is stable: it is never given another meaning nor used again. `C01xx` is the file, `C02xx`
//! what a program needs and the workcell has not. Knows nothing of how any of it is found.

obverse_codes::table! {
    CellCode "A kind of mistake in a workcell file."

    Toml "C0101" "a workcell file that is no TOML"
        why "A workcell file is written in TOML: tables in brackets, keys and values with `=` \
             between, texts in quotes."
        wrong "[arm\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]"
    Key "C0102" "a key that is unknown, missing, or of another type"
        why "Each table of a workcell file has its keys, some of which it must have, each with \
             values of one type. A key that is not known is refused, since it is most likely \
             misspelt and would otherwise do nothing."
        wrong "[arm]\nhome_rads = [0, -1.5, 1.5, 0, 0, 0]"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]"
    Range "C0103" "a number that is out of range"
        why "Every number has a range that makes sense for what it is, in the unit that its key \
             ends with. Often the unit was another one: metres in place of millimetres."
        wrong "[arm]\nhome_rad = [0, -90, 90, 0, 0, 0]"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]"
    UnknownName "C0104" "a name or number that the file gives to nothing"
        why "Tools, items and fixtures are named by tables of the file, and outputs and inputs are \
             numbered from 0 to below the count of their table. A thing stands on a fixture that \
               is \
             described above it."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[inputs]\ncount = 2\n[[inputs.rule]]\n\
               input = 2\nholding = true"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[inputs]\ncount = 2\n[[inputs.rule]]\n\
               input = 1\nholding = true"
    Twice "C0105" "something that is there twice"
        why "Tools, items, fixtures and feeders each have names of their own, a line of outputs or \
             inputs is described once, and an item comes from one feeder."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[[tool]]\nname = \"a\"\n[[tool]]\nname \
               = \"a\""
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[[tool]]\nname = \"a\"\n[[tool]]\nname \
               = \"b\""
    TooMany "C0106" "more than there may be"
        why "A workcell has limits, so that it is simulated in reasonable time and memory: of \
             items, fixtures, tools, parts of a body, lines, changes of an input, and of the file \
             itself."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 2000"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 200"
    Contradiction "C0107" "keys that do not go together"
        why "Each key by itself is right, and together they describe nothing that can be: the home \
             of the arm is outside the range of a joint, a hole is not in its fixture, a chamfer \
             takes the whole tip, one key needs another or excludes it."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\nlimits_deg = [[-170, 170], [-60, 60], \
               [-170, 170], [-170, 170], [-170, 170], [-170, 170]]"
        right "[arm]\nhome_rad = [0, -1.0, 1.5, 0, 0, 0]\nlimits_deg = [[-170, 170], [-60, 60], \
               [-170, 170], [-170, 170], [-170, 170], [-170, 170]]"
    Overlap "C0108" "two things in one place"
        why "Fixtures may touch, and what stands on one may lie on it; their bodies cannot be in \
             one place, nor two holes of a fixture. An item is in no fixture, but for a hole that \
             it fits, and in no other item; what a feeder has yet to bring is not there yet. At \
             home the arm and its tool are in neither, but for the item in the gripper. It is \
             looked at where things should stand, without their offsets, and items and the arm \
             may be pressed into what they touch by half a millimetre. A body that is made of \
             several parts belongs into one fixture."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[[fixture]]\nname = \"table\"\nplace \
               = { xyz_mm = [0, 0, -20] }\nbody = [{ cuboid_mm = [900, 900, 40] }]\n\
               [[fixture]]\nname = \"nest\"\nplace = { xyz_mm = [300, 0, 0] }\nbody = [{ \
               cuboid_mm = [60, 60, 20] }]"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[[fixture]]\nname = \"table\"\nplace \
               = { xyz_mm = [0, 0, -20] }\nbody = [{ cuboid_mm = [900, 900, 40] }]\n\
               [[fixture]]\nname = \"nest\"\nplace = { xyz_mm = [300, 0, 10] }\nbody = [{ \
               cuboid_mm = [60, 60, 20] }]"
    NoItem "C0201" "an item that the workcell has not"
        why "A program that declares an item runs in a workcell that has one of this name: a table \
             `[[item]]`. The example is for a program with `item vial { .. }`."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\""
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
    NoTool "C0202" "a tool that the workcell has not"
        why "A program that mounts a tool runs in a workcell that has one of this name: a table \
             `[[tool]]`. The example is for a program with `tool gripper`."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[item]]\nname = \"vial\"\nplace = { }"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
    NoOutput "C0203" "an output that the workcell has not"
        why "Outputs are numbered from 0 to below the `count` of `[outputs]`. The example is for a \
             program with `set 3 high`."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 3\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
    NoInput "C0204" "an input that the workcell has not"
        why "Inputs are numbered from 0 to below the `count` of `[inputs]`. The example is for a \
             program with `if input 3 { .. }`."
        wrong "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               3\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
        right "[arm]\nhome_rad = [0, -1.5, 1.5, 0, 0, 0]\n[outputs]\ncount = 4\n[inputs]\ncount = \
               4\n[[tool]]\nname = \"gripper\"\n[[item]]\nname = \"vial\"\nplace = { }"
}
