; Two mugs of coffee wait on the counter, one of which has become cold; guest1 wants a hot one.

(defproblem serve_hot_coffee restaurant
  (
    ; the robot: somewhere on the floor, torso down, arms opened after start-up, hands empty
    (RobotAt floorareatamsrestaurant1)
    (HasTorsoPosture torsodownposture)
    (HasArmPosture leftarm1 armuntuckedposture) (HasArmPosture rightarm1 armuntuckedposture)
    (Holding leftarm1 nothing) (Holding rightarm1 nothing)

    ; guests
    (At guest1 sittingareawesttable1) (At guest2 sittingareaeasttable1)
    (At guest3 sittingareanorthtable2) (At guest4 sittingareasouthtable2)

    ; objects
    (Type coffee mug1) (Type mug mug1) (Type coffee mug2) (Type mug mug2)
    (On mug1 placingareaeastrightcounter1) (On mug2 placingareaeastrightcounter1)

    ; what the thermal camera has seen, in degrees Celsius
    (HasTemperature mug1 21) (HasTemperature mug2 62.5))

  ((serve_hot_coffee_to_guest guest1)))
