/* The table of exporters. */
#include <ritz/export.h>

const ritz_exporter *const ritz_exporters[] = {
    &ritz_exporter_42,           &ritz_exporter_basilisk,
    &ritz_exporter_chrono,       &ritz_exporter_container,
    &ritz_exporter_dmig,         &ritz_exporter_exudyn,
    &ritz_exporter_fmu,          &ritz_exporter_fxbody,
    &ritz_exporter_matlab,       &ritz_exporter_matrix_market,
    &ritz_exporter_mbdyn,        &ritz_exporter_openfast,
    &ritz_exporter_openfast_4,   &ritz_exporter_output4,
    &ritz_exporter_sid,          &ritz_exporter_simscape,
    &ritz_exporter_superelement, &ritz_exporter_tsv,
    &ritz_exporter_uff,          &ritz_exporter_vtu,
    &ritz_exporter_xdmf,         NULL,
};
