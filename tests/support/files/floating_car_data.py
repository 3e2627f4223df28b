"""A small file of SUMO's floating car data."""

# Written by hand after the description of the format (sumo.dlr.de, "FCDOutput"): positions are those of the middle of the front
# bumper, angles go clockwise from north.
FCD = """<?xml version="1.0" encoding="UTF-8"?>
<fcd-export xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://sumo.dlr.de/xsd/fcd_file.xsd">
    <timestep time="0.00">
        <vehicle id="flow/0" x="10.00" y="0.00" angle="90.00" type="passenger" speed="10.00" pos="5" lane="a_0" slope="0.00"/>
        <person id="walker" x="3.00" y="4.00" angle="0.00" speed="1.00" pos="1.00" edge="a" slope="0.00"/>
    </timestep>
    <timestep time="1.00">
        <vehicle id="flow/0" x="20.00" y="0.00" angle="90.00" type="passenger" speed="10.00" pos="15" lane="a_0" slope="0.00"/>
        <vehicle id="south" x="50.00" y="40.00" angle="180.00" type="truck" speed="8.00" pos="5.10" lane="b_0" slope="0.00"/>
        <person id="walker" x="3.00" y="5.00" angle="0.00" speed="1.00" pos="2.00" edge="a" slope="0.00"/>
    </timestep>
    <timestep time="2.00">
        <vehicle id="flow/0" x="30.00" y="0.00" angle="90.00" type="passenger" speed="10.00" pos="25" lane="a_0" slope="0.00"/>
        <vehicle id="south" x="50.00" y="32.00" angle="180.00" type="truck" speed="8.00" pos="13.10" lane="b_0" slope="0.00"/>
        <vehicle id="once" x="0.00" y="0.00" angle="0.00" type="passenger" speed="8.00" pos="1.00" lane="c_0" slope="0.00"/>
    </timestep>
</fcd-export>
"""
