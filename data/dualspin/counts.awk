# Counts of this demonstration beside those of the spacecraft that it takes its
# shape from [LeeTsuha1992, table 1], read from the report of ritz-compare.
# There the stator is printed together with the platform and the turning of the
# bearing: 29 + 21 - 6 = 44.
$1 == "rotor" && NF == 5 { full = $2; first = $3; rotor = $4 }
$1 == "stator" && NF == 5 { full_s = $2; first_s = $3; stator = $4 }
$1 == "platform" && NF == 5 { platform = $4 }
$1 ~ /^[0-9]+$/ && $2 ~ /^clock=/ {
    rigid = $3
    order = $6
    if (!(most > $5))
        most = $5
    if (!least || $5 < least)
        least = $5
}
END {
    cone = 5 # what the cone hinge holds; the clock hinge leaves 1 to the group
    printf "Counts beside [LeeTsuha1992], whose matrices were never published:\n\n"
    printf "%-46s %10s %10s\n", "", "there", "here"
    line = "%-46s %10s %10s\n"
    printf line, "dofs of rotor, stator, platform", "243 57 6", full " " full_s " 6"
    printf line, "clock angles", "6", 6
    printf line, "rigid modes kept at each", 8, rigid
    printf line, "flexible modes kept, in all there, at each here", 21, \
        least == most ? most : least " to " most
    printf line, "residual modes at the bearing", 2, 2
    printf line, "reduced rotor, 6 of them rigid", 29, rotor
    printf line, "stator, platform and bearing, 8 rigid", 21, \
        stator + platform - cone + 1
    printf line, "assembled, 8 rigid", 44, order
}
