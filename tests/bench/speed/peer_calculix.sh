#!/bin/sh
# peer_calculix.sh NAME.inp FOLDER - the job by CalculiX from the mesh: 50 modes
# with the interface held, then *SUBSTRUCTURE GENERATE. Prints one JSON object;
# CalculiX gives eigenvalues with seven digits.
set -eu
mesh=$1
mkdir -p "$2"
cd "$2"
cat >modes.inp <<TEXT
*INCLUDE,INPUT=$mesh
*BOUNDARY
PORT,1,3
*STEP
*FREQUENCY
50
*END STEP
TEXT
cat >static.inp <<TEXT
*INCLUDE,INPUT=$mesh
*STEP
*SUBSTRUCTURE GENERATE
*RETAINED NODAL DOFS
PORT,1,3
*SUBSTRUCTURE MATRIX OUTPUT,FILE NAME=static,STIFFNESS=YES
*END STEP
TEXT
for job in modes static; do
    ccx $job >$job.log
done
awk '/Total CalculiX Time:/ { time[FILENAME] = $4 }
    /E I G E N V A L U E   O U T P U T/ { table = 1 }
    /P A R T I C I P A T I O N/ { table = 0 }
    table && $1 ~ /^[0-9]+$/ && NF == 5 {
        values = values (values == "" ? "" : ", ") $2
    }
    END {
        printf "{\"phases\": {\"modes\": %s, \"columns\": %s}, ",
            time["modes.log"], time["static.log"]
        printf "\"values\": [%s]}\n", values
    }' modes.log static.log modes.dat
