"""Reading what mpmFoam (and interFoam beside it) wrote.

foamFile        one OpenFOAM file: lists and internal fields, ascii or binary
case            a case directory: times, clouds, mesh fields, serial or decomposed
postProcessing  the .dat files of function objects, over all start times
runLog          the solver's log: steps, times, limiters, cost
metrics         metrics.json
reference       reference data: .csv with a commented header
study           runs many cases from one template, resumably
style           the one look of all figures (needs matplotlib; not imported here)

Needs numpy only, style excepted. Scripts find the package by

    PYTHONPATH=$MPMFOAM_DIR/etc/python
"""
