"""The parameters of ICAROUS by name, with unit and default, and their meaning here.

137 names of its parameter files (as of 2022-01-12), in groups: those that set an item of a mission, and those
not used here, with the reason. Names, units and defaults are facts of the format; the descriptions are our
own.
"""

from __future__ import annotations

from typing import NamedTuple


class Name(NamedTuple):
    """One name of a parameter file. item: of the mission file that it sets, "" if it is not used here; why:
    how it does, or why not.
    """

    name: str
    default: str
    unit: str
    item: str
    why: str


class Group(NamedTuple):
    """Names with the same item and reason: (name, default, unit) each."""

    item: str
    why: str
    names: tuple[tuple[str, str, str], ...]


GROUPS = (
    Group("vehicles[].min_speed_m_s", "", (
        ("min_hs", "0.2", "knot"),
    )),
    Group("vehicles[].max_speed_m_s", "", (
        ("max_hs", "30.0", "knot"),
    )),
    Group("vehicles[].max_climb_m_s", "the smaller of both: climb and descent have one limit", (
        ("min_vs", "-500.0", "fpm"), ("max_vs", "500.0", "fpm"),
    )),
    Group("", "altitudes are bounded by zones: say a keep-in with floor and ceiling", (
        ("min_alt", "15.0", "ft"), ("max_alt", "500.0", "ft"),
    )),
    Group("", "the simulated airframe has its own acceleration", (
        ("horizontal_accel", "1.0", "m/s^2"), ("vertical_accel", "1.0", "m/s^2"),
    )),
    Group("vehicles[].max_bank_deg", "the bank that turns so fast at cruise speed", (
        ("turn_rate", "10.0", "deg/s"),
    )),
    Group("", "climbs are flown at max_climb_m_s", (
        ("vertical_rate", "500.0", "fpm"),
    )),
    Group("", "the bands look at all headings, and at all speeds that the airframe can fly", (
        ("left_hdir", "180.0", "deg"), ("right_hdir", "180.0", "deg"),
        ("below_relative_hs", "100.0", "knot"), ("above_relative_hs", "100.0", "knot"),
    )),
    Group("", "the bands look at what max_climb_m_s reaches within lookahead_s", (
        ("below_relative_vs", "5000.0", "fpm"), ("above_relative_vs", "5000.0", "fpm"),
        ("below_relative_alt", "10000.0", "ft"), ("above_relative_alt", "10000.0", "ft"),
    )),
    Group("", "the bands step by 5 deg, and by a twelfth of what the airframe can do", (
        ("step_hdir", "1.0", "deg"), ("step_hs", "2.0", "knot"), ("step_vs", "100.0", "fpm"),
        ("step_alt", "50.0", "ft"),
    )),
    Group("", "recovery begins with the cylinder of the thresholds: dthr_m, zthr_m", (
        ("min_horizontal_recovery", "30.0", "ft"), ("min_vertical_recovery", "30.0", "ft"),
    )),
    Group("", "recovery is always looked for where nothing keeps well clear, and may be flown", (
        ("recovery_hdir", "true", ""), ("recovery_hs", "true", ""), ("recovery_vs", "true", ""),
        ("recovery_alt", "true", ""),
    )),
    Group("daa.guidance.recovery_shrinks", "", (
        ("ca_bands", "true", ""),
    )),
    Group("daa.guidance.recovery_factor", "", (
        ("ca_factor", "0.1", ""),
    )),
    Group("daa.guidance.recovery_stable_s", "", (
        ("recovery_stability_time", "3.0", "s"),
    )),
    Group("daa.guidance.hysteresis_s", "", (
        ("hysteresis_time", "3.0", "s"),
    )),
    Group("daa.guidance.persistence_s", "", (
        ("persistence_time", "3.0", "s"),
    )),
    Group("daa.guidance.bands_persistence", "", (
        ("bands_persistence", "true", ""),
    )),
    Group("daa.guidance.preferred_heading_deg", "", (
        ("persistence_preferred_hdir", "5.0", "deg"),
    )),
    Group("daa.guidance.preferred_speed_m_s", "", (
        ("persistence_preferred_hs", "2.0", "knot"),
    )),
    Group("daa.guidance.preferred_climb_m_s", "", (
        ("persistence_preferred_vs", "50.0", "fpm"),
    )),
    Group("daa.guidance.preferred_alt_m", "", (
        ("persistence_preferred_alt", "30.0", "ft"),
    )),
    Group("", "contours are not looked for in flight", (
        ("contour_thr", "180.0", "deg"),
    )),
    Group("", "the bands resolve the region MID: the buffered volume within lookahead_s", (
        ("corrective_region", "NEAR", ""),
    )),
    Group("", "500 ft and 100 ft, or the thresholds where they are less; not judged", (
        ("horizontal_nmac", "5.0", "ft"), ("vertical_nmac", "5.5", "ft"),
    )),
    Group("daa.guidance.alerting_m", "", (
        ("alerting_m", "2", ""),
    )),
    Group("daa.guidance.alerting_n", "", (
        ("alerting_n", "4", ""),
    )),
    Group("", "who takes over and when is decided by predicted losses, not by alert levels", (
        ("ownship_centric_alerting", "true", ""),
    )),
    Group("", "two levels: the buffered volume, and the volume itself as late as all have to act", (
        ("default_alert_1_region", "NEAR", ""), ("default_alert_1_alerting_time", "10.0", "s"),
        ("default_alert_1_early_alerting_time", "15.0", "s"),
        ("default_alert_1_detector", "det_1", ""),
    )),
    Group("", "the levels in flight have no spread", (
        ("default_alert_1_spread_hdir", "0.0", "deg"), ("default_alert_1_spread_hs", "0.0", "knot"),
        ("default_alert_1_spread_vs", "0.0", "fpm"), ("default_alert_1_spread_alt", "0.0", "ft"),
    )),
    Group("daa.guidance.conflict_crit", "", (
        ("conflict_crit", "false", ""),
    )),
    Group("daa.guidance.recovery_crit", "", (
        ("recovery_crit", "false", ""),
    )),
    Group("", "how far off a track may be is `sigmas` of the section `sensing`", (
        ("h_pos_z_score", "0.0", ""), ("h_vel_z_score_min", "0.0", ""),
        ("h_vel_z_score_max", "0.0", ""), ("h_vel_z_distance", "0.0", "nmi"),
        ("v_pos_z_score", "0.0", ""), ("v_vel_z_score", "0.0", ""),
    )),
    Group("", "no terminal area is modelled in flight", (
        ("dta_logic", "0", ""), ("dta_latitude", "0.0", "deg"), ("dta_longitude", "0.0", "deg"),
        ("dta_radius", "0.0", "nmi"), ("dta_height", "0.0", "ft"), ("dta_alerter", "0", ""),
    )),
    Group("daa.lookahead_s", "", (
        ("lookahead_time", "20.0", "s"),
    )),
    Group("", "there is one volume for all aircraft", (
        ("alerters", "default", ""), ("sensor_mapping", "false", ""),
    )),
    Group("daa.well_clear.dthr_m", "", (
        ("default_det_1_WCV_DTHR", "30.0", "ft"),
    )),
    Group("daa.well_clear.zthr_m", "", (
        ("default_det_1_WCV_ZTHR", "30.0", "ft"),
    )),
    Group("daa.well_clear.tthr_s", "", (
        ("default_det_1_WCV_TTHR", "5.0", "s"),
    )),
    Group("daa.well_clear.tcoa_s", "", (
        ("default_det_1_WCV_TCOA", "5.0", "s"),
    )),
    Group("", "the volume here is WCV_TAUMOD, and another is refused", (
        ("default_load_core_detection_det_1", "gov.nasa.larcfm.ACCoRD.WCV_TAUMOD", ""),
    )),
    Group("bridge.instances", "true: 0, ICAROUS watches no vehicle; false: all", (
        ("passive_mode", "false", ""),
    )),
    Group("", "daa.resolution of a mission says which kind of manoeuvre is looked for first", (
        ("daa_resolution_type", "2", ""),
    )),
    Group("", "a vehicle off its path is on its way back, or steered by ICAROUS", (
        ("allowed_xtrk_deviation", "10000", "m"),
    )),
    Group("", "the way back is the one that is free soonest", (
        ("return_nextwp", "true", ""), ("return_vector", "true", ""),
    )),
    Group("", "what is predicted is always the way that was told", (
        ("verify_conflict_with_plan", "false", ""),
    )),
    Group("", "there is one look-ahead: lookahead_time", (
        ("plan_lookahead", "20", "s"),
    )),
    Group("", "zones are kept by the plan and by every manoeuvre", (
        ("fence_action", "0", ""), ("rtl_altitude", "0", "m"),
    )),
    Group("vehicles[].speed_m_s", "where the flight plan says no speed", (
        ("default_wp_speed", "1.0", "m/s"),
    )),
    Group("", "times are those of the plan and of the relations", (
        ("maintain_eta", "False", ""),
    )),
    Group("", "the autopilot follows the track, and captures no points", (
        ("capture_radius_scaling", "2.0", ""), ("max_capture_radius", "50", "m"),
        ("min_capture_radius", "1", "m"), ("guidance_radius_scaling", "2.0", ""),
        ("vertical_climb_delta", "10", "m"), ("climb_angle", "45", "deg"),
        ("climb_rate_gain", "0.5", ""), ("yaw_forward", "1", ""), ("turnrate_gain", "5", ""),
        ("climb_speed", "2", "m/s"),
    )),
    Group("", "the log of a run has everything", (
        ("record_daa_logs", "true", ""), ("tracker_log", "true", ""),
    )),
    Group("", "all traffic of the mission counts", (
        ("traffic_source", "0", ""),
    )),
    Group("", "how long a track lasts is `coast_s` of the section `sensing`", (
        ("stale_threshold", "10", "s"), ("track_timeout", "5", "s"),
    )),
    Group("zones[].padding_m", "of keep-outs", (
        ("obstacle_buffer", "5", "m"),
    )),
    Group("", "ways are searched with the volume that is kept: the thresholds", (
        ("dubins_wellclear_radius", "30.0", "ft"), ("dubins_wellclear_height", "30.0", "ft"),
    )),
    Group("", "ways have no layers of altitude", (
        ("alt_bins", "1", ""),
    )),
    Group("", "the section `merging` of a mission says it, with its fix, which no such file names", (
        ("separation_time", "20.0", "s"), ("coordination_zone", "90.0", "m"),
        ("schedule_zone", "70.0", "m"), ("entry_zone", "60.0", "m"),
    )),
    Group("", "slots are times at one fix: corridors have no width", (
        ("corridor_width", "0.0", "m"),
    )),
    Group("", "what ICAROUS does next is decided by proved kernels, not by priorities", (
        ("Priority_Takeoff", "1", ""), ("Priority_NominalDeparture", "6", ""),
        ("Priority_PrimaryPlanComplete", "1", ""), ("Priority_SecondaryPlanComplete", "1", ""),
        ("Priority_Replanning", "3", ""), ("Priority_Merging", "3", ""),
        ("Priority_FenceConflict", "1", ""), ("Priority_TrafficConflict1", "2", ""),
        ("Priority_TrafficConflict2", "2", ""), ("Priority_TrafficConflict3", "4", ""),
        ("Priority_FlightPlanDeviation", "1", ""), ("Priority_Ditching", "5", ""),
        ("Priority_TODReached", "1", ""),
    )),
    Group("", "tracks are made as the section `sensing` says, by a model of its own", (
        ("pos_model_uncertainty_xx", "10.0", "m^2"), ("pos_model_uncertainty_yy", "10.0", "m^2"),
        ("pos_model_uncertainty_zz", "10.0", "m^2"), ("pos_model_uncertainty_xy", "0.0", "m^2"),
        ("pos_model_uncertainty_yz", "0.0", "m^2"), ("pos_model_uncertainty_xz", "0.0", "m^2"),
        ("vel_model_uncertainty_xx", "1.0", "m^2"), ("vel_model_uncertainty_yy", "1.0", "m^2"),
        ("vel_model_uncertainty_zz", "1.0", "m^2"), ("vel_model_uncertainty_xy", "0.0", "m^2"),
        ("vel_model_uncertainty_yz", "0.0", "m^2"), ("vel_model_uncertainty_xz", "0.0", "m^2"),
        ("pos_chi_threshold", "16.27", ""), ("vel_chi_threshold", "16.27", ""),
    )),)  # fmt: skip

NAMES: dict[str, Name] = {
    name: Name(name, default, unit, group.item, group.why)
    for group in GROUPS
    for name, default, unit in group.names
}
"""The parameters by name."""
