"""Scenarios for the tests of the simulator: one aircraft at 45 N, 120 W that flies north."""

from __future__ import annotations

PROFILES = """<NominalFlightProfile><FlightProfile Series="CMASI"><Name>cruise</Name>
<Airspeed>22</Airspeed><MaxBankAngle>30</MaxBankAngle><EnergyRate>0.01</EnergyRate>
</FlightProfile></NominalFlightProfile><AlternateFlightProfiles>
<FlightProfile Series="CMASI"><Airspeed>24</Airspeed><PitchAngle>8</PitchAngle>
<VerticalSpeed>5</VerticalSpeed><MaxBankAngle>20</MaxBankAngle></FlightProfile>
<FlightProfile Series="CMASI"><Airspeed>26</Airspeed><PitchAngle>-6</PitchAngle>
<VerticalSpeed>-6</VerticalSpeed><MaxBankAngle>20</MaxBankAngle></FlightProfile>
</AlternateFlightProfiles>"""
LOITER = """<LoiterAction Series="CMASI"><LoiterType>{}</LoiterType><Radius>300</Radius>
<Length>600</Length><Duration>{}</Duration><Airspeed>22</Airspeed><Location><Location3D Series="CMASI">
<Latitude>45.02</Latitude><Longitude>-120</Longitude><Altitude>400</Altitude></Location3D></Location>
</LoiterAction>"""
DIRECTOR = """<FlightDirectorAction Series="CMASI"><Heading>90</Heading><Altitude>600</Altitude>
<Speed>22</Speed><ClimbRate>3</ClimbRate></FlightDirectorAction>"""
GO_TO = (
    '<GoToWaypointAction Series="CMASI"><WaypointNumber>{}</WaypointNumber></GoToWaypointAction>'
)

CAMERA = """<GimbalConfiguration Series="CMASI"><PayloadID>1</PayloadID><MinElevation>-90</MinElevation>
<MaxElevation>0</MaxElevation><MinAzimuth>-180</MinAzimuth><MaxAzimuth>180</MaxAzimuth>
<MaxElevationSlewRate>60</MaxElevationSlewRate><MaxAzimuthSlewRate>60</MaxAzimuthSlewRate>
<ContainedPayloadList><int64>2</int64></ContainedPayloadList></GimbalConfiguration>
<CameraConfiguration Series="CMASI"><PayloadID>2</PayloadID>
<MinHorizontalFieldOfView>10</MinHorizontalFieldOfView>
<MaxHorizontalFieldOfView>50</MaxHorizontalFieldOfView></CameraConfiguration>"""
STARE = """<GimbalStareAction Series="CMASI"><PayloadID>1</PayloadID><Starepoint>
<Location3D Series="CMASI"><Latitude>45.01</Latitude><Longitude>-119.995</Longitude></Location3D>
</Starepoint></GimbalStareAction>"""
DOWN = """<GimbalAngleAction Series="CMASI"><PayloadID>1</PayloadID><Azimuth>0</Azimuth>
<Elevation>-90</Elevation></GimbalAngleAction>"""


def waypoint(number: int, following: int, lat: float, more: str = "") -> str:
    return f"""<Waypoint Series="CMASI"><Number>{number}</Number><NextWaypoint>{following}</NextWaypoint>
<Speed>22</Speed><VehicleActionList>{more}</VehicleActionList><Latitude>{lat}</Latitude>
<Longitude>-120</Longitude><Altitude>400</Altitude></Waypoint>"""


def mission(*waypoints: str) -> str:
    return f"""<MissionCommand Series="CMASI" Time="1"><CommandID>7</CommandID><VehicleID>1</VehicleID>
<WaypointList>{"".join(waypoints)}</WaypointList><FirstWaypoint>1</FirstWaypoint></MissionCommand>"""


def ordered(time_s: float, action: str) -> str:
    return f"""<VehicleActionCommand Series="CMASI" Time="{time_s}"><CommandID>8</CommandID>
<VehicleID>1</VehicleID><VehicleActionList>{action}</VehicleActionList></VehicleActionCommand>"""


def scenario(*events: str, least_m_s: float = 18, payloads: str = "", energy: float = 100) -> str:
    return f"""<AMASE><ScenarioData><ScenarioDuration>600</ScenarioDuration></ScenarioData>
<ScenarioEventList><AirVehicleConfiguration Series="CMASI"><ID>1</ID>
<MinimumSpeed>{least_m_s}</MinimumSpeed><MaximumSpeed>40</MaximumSpeed>{PROFILES}
<PayloadConfigurationList>{payloads}</PayloadConfigurationList></AirVehicleConfiguration>
<AirVehicleState Series="CMASI"><ID>1</ID><u>22</u><Airspeed>22</Airspeed>
<EnergyAvailable>{energy}</EnergyAvailable><Location><Location3D Series="CMASI"><Latitude>45</Latitude>
<Longitude>-120</Longitude><Altitude>400</Altitude></Location3D></Location></AirVehicleState>
{"".join(events)}</ScenarioEventList></AMASE>"""
